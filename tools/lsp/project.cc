// Which texts belong together. An editor asks about one file, and the answer lies in several: the
// model that a scenario names, the files that it loads, the plan and its binding table. They are
// found by the names of files that texts mention, so that they are found in half-typed texts, too.
// Linear in the texts of the folder.

#include "tools/lsp/project.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <set>
#include <string_view>
#include <system_error>

#include "tools/lsp/file_text.h"

namespace parallax::tools::lsp {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostRoots = 8, kMostFiles = 200, kMostNeighbours = 500;

/// File names that a text mentions: words with dots and slashes that end as files of a project do.
std::vector<std::string> mentioned(std::string_view text, bool yaml) {
  constexpr std::array<std::string_view, 5> kEndings = {".e", ".yaml", ".yml", ".bind", ".lisp"};
  std::vector<std::string> out;
  each_line(text, [&](std::size_t, std::string_view whole) {
    const auto line = without_comment(whole, yaml);
    for (std::size_t i = 0; i < line.size();) {
      const auto in_path = [&](char c) { return is_word(c) || c == '.' || c == '/' || c == '-'; };
      auto end = i;
      while (end < line.size() && in_path(line[end])) ++end;
      const auto word = line.substr(i, end - i);
      const bool is_file = std::any_of(kEndings.begin(), kEndings.end(), [&](auto ending) {
        return word.size() > ending.size() && word.ends_with(ending);
      });
      if (is_file) out.emplace_back(word);
      i = end == i ? i + 1 : end;
    }
  });
  return out;
}

std::string beside(const std::string& path, const std::string& name) {
  return (fs::path(path).parent_path() / name).lexically_normal().string();
}

/// The files that a file mentions, read once.
class Mentions {
 public:
  explicit Mentions(const TextOf& text_of) : text_of_(text_of) {}
  bool operator()(const std::string& from, const std::string& to) {
    const auto known = known_.find(from);
    const auto& names = known == known_.end() ? read(from) : known->second;
    return names.contains(to);
  }

 private:
  const std::set<std::string>& read(const std::string& from) {
    auto& names = known_[from];
    const auto text = text_of_(from);
    if (!text) return names;
    for (const auto& name : mentioned(*text, is_yaml(from))) names.insert(beside(from, name));
    return names;
  }

  const TextOf& text_of_;
  std::map<std::string, std::set<std::string>> known_;
};

/// Has the YAML a model, so that it can be checked as a scenario?
bool is_scenario(const std::string& path, const TextOf& text_of) {
  const auto text = is_yaml(path) ? text_of(path) : std::nullopt;
  if (!text) return false;
  bool found = false;
  each_line(*text, [&](std::size_t, std::string_view line) {
    found = found || line.starts_with("model:");
  });
  return found;
}

std::vector<std::string> neighbours(const std::string& path) {
  std::vector<std::string> out;
  std::error_code error;
  for (fs::directory_iterator at(fs::path(path).parent_path(), error), end; !error && at != end;
       at.increment(error)) {
    const auto name = at->path().string();
    if ((is_yaml(name) || is_model(name)) && name != path) out.push_back(name);
    if (out.size() == kMostNeighbours) break;
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

std::vector<std::string> roots_of(const std::string& path, const TextOf& text_of) {
  if (is_scenario(path, text_of)) return {path};
  std::vector<std::string> roots;
  std::set<std::string> seen = {path};
  std::vector<std::string> open = {path};
  const auto around = neighbours(path);
  Mentions mentions(text_of);
  // Who mentions the file, who mentions these, and so on; scenarios are ends.
  while (!open.empty() && seen.size() < kMostFiles) {
    const auto at = open.back();
    open.pop_back();
    for (const auto& other : around) {
      if (seen.contains(other) || !mentions(other, at)) continue;
      seen.insert(other);
      if (is_scenario(other, text_of)) {
        roots.push_back(other);
      } else {
        open.push_back(other);
      }
    }
  }
  if (roots.empty() && is_model(path)) {
    // A model without scenarios: the files that load it, or itself.
    for (const auto& other : seen) {
      if (!is_model(other)) continue;
      const bool is_loaded = std::any_of(seen.begin(), seen.end(), [&](const auto& by) {
        return by != other && is_model(by) && mentions(by, other);
      });
      if (!is_loaded) roots.push_back(other);
    }
    if (roots.empty()) roots.push_back(path);
  }
  std::sort(roots.begin(), roots.end());
  if (roots.size() > kMostRoots) roots.resize(kMostRoots);
  return roots;
}

std::vector<std::string> files_below(const std::string& root, const TextOf& text_of) {
  std::vector<std::string> out = {root};
  std::set<std::string> seen = {root};
  for (std::size_t i = 0; i < out.size() && out.size() < kMostFiles; ++i) {
    const auto from = out[i];
    const auto text = text_of(from);
    if (!text) continue;
    for (const auto& name : mentioned(*text, is_yaml(from))) {
      const auto path = beside(from, name);
      if (seen.insert(path).second && text_of(path)) out.push_back(path);
    }
  }
  return out;
}

std::vector<std::string> family_of(const std::string& path, const TextOf& text_of) {
  std::vector<std::string> family = {path};
  std::set<std::string> seen = {path}, roots;
  for (std::size_t i = 0; i < family.size() && family.size() < kMostFiles; ++i) {
    const auto member = family[i];
    for (const auto& root : roots_of(member, text_of)) {
      if (!roots.insert(root).second) continue;
      for (auto& file : files_below(root, text_of)) {
        if (seen.insert(file).second) family.push_back(std::move(file));
      }
    }
  }
  std::sort(family.begin(), family.end());
  return family;
}

}  // namespace parallax::tools::lsp
