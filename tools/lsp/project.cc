// Which texts belong together, and where a name stands in them.
//
// An editor asks about one file, and the answer lies in several: the model that a scenario names,
// the files that it loads, the binding table of the plan. They are found by the names of files that
// texts mention, so that they are found in half-typed texts, too. Names are taken from declarations
// by the compiler's own parser, which goes on after errors; their places are the lexer's names in
// models, and words in tables and scenarios. Linear in the texts.

#include "tools/lsp/project.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <set>

#include "compiler/base/diagnostic.h"
#include "compiler/base/source_file.h"
#include "compiler/syntax/lexer.h"
#include "compiler/syntax/parser.h"

namespace parallax::tools::lsp {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostRoots = 8, kMostFiles = 200, kMostNeighbours = 500;

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

bool has_ending(std::string_view path, std::string_view ending) { return path.ends_with(ending); }
bool is_yaml(std::string_view path) {
  return has_ending(path, ".yaml") || has_ending(path, ".yml");
}
bool is_model(std::string_view path) { return has_ending(path, ".e"); }

/// The position behind the comment of a line: `;` in models and tables, `#` in YAML.
std::string_view without_comment(std::string_view line, bool yaml) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (!yaml && line[i] == ';') return line.substr(0, i);
    if (yaml && line[i] == '#' && (i == 0 || line[i - 1] == ' ')) return line.substr(0, i);
  }
  return line;
}

template <typename Each>
void each_line(std::string_view text, const Each& each) {
  for (std::size_t at = 0; at <= text.size();) {
    const auto end = std::min(text.find('\n', at), text.size());
    each(at, text.substr(at, end - at));
    at = end + 1;
  }
}

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

/// The name without digits at its end: a variable's sort.
std::string_view stem(std::string_view word) {
  while (!word.empty() && std::isdigit(static_cast<unsigned char>(word.back())) != 0)
    word.remove_suffix(1);
  return word;
}

NameKind kind_of(std::string_view sort) {
  if (sort == "fluent") return NameKind::kFluent;
  if (sort == "event") return NameKind::kEvent;
  if (sort == "predicate") return NameKind::kPredicate;
  return NameKind::kFunction;
}

/// The comment lines directly above an offset, without their signs.
std::string comment_above(std::string_view text, std::size_t offset) {
  std::vector<std::string_view> lines;
  auto begin = text.rfind('\n', offset == 0 ? 0 : offset - 1);
  begin = begin == std::string_view::npos ? 0 : begin + 1;
  while (begin > 0) {
    const auto before = text.rfind('\n', begin - 2);
    const auto from = begin < 2 || before == std::string_view::npos ? 0 : before + 1;
    auto line = text.substr(from, begin - 1 - from);
    while (!line.empty() && std::isspace(static_cast<unsigned char>(line.front())) != 0)
      line.remove_prefix(1);
    if (!line.starts_with(';')) break;
    while (line.starts_with(';') || line.starts_with(' ')) line.remove_prefix(1);
    lines.push_back(line);
    begin = from;
  }
  std::string out;
  for (auto line = lines.rbegin(); line != lines.rend(); ++line)
    out += std::string(out.empty() ? "" : "\n") + std::string(*line);
  return out;
}

/// Keys of scenarios whose values are words for people.
bool is_prose(std::string_view line) {
  constexpr std::array<std::string_view, 5> kKeys = {
      "name:", "title:", "because:", "reason:", "about:"};
  while (line.starts_with(' ') || line.starts_with('-')) line.remove_prefix(1);
  return std::any_of(kKeys.begin(), kKeys.end(), [&](auto key) { return line.starts_with(key); });
}

}  // namespace

std::string_view to_string(NameKind kind) {
  switch (kind) {
    case NameKind::kSort:
      return "sort";
    case NameKind::kConstant:
      return "constant";
    case NameKind::kFluent:
      return "fluent";
    case NameKind::kEvent:
      return "event";
    case NameKind::kPredicate:
      return "predicate";
    case NameKind::kFunction:
      break;
  }
  return "function";
}

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

NameMap::NameMap(const std::vector<std::string>& paths, const TextOf& text_of) {
  std::vector<std::pair<std::string, std::string>> texts;
  for (const auto& path : paths) {
    if (auto text = text_of(path)) texts.emplace_back(path, *std::move(text));
  }
  for (const auto& [path, text] : texts) {
    if (is_model(path)) declare(path, text);
  }
  for (const auto& [path, text] : texts) add_words(path, text);
}

void NameMap::declare(const std::string& path, const std::string& text) {
  base::SourceFiles files;
  base::DiagnosticSink unread;
  const auto ast = compiler::parse_file(files.add(path, text), files, unread);
  const auto add = [&](const compiler::Word& word, NameKind kind, std::string declaration) {
    DeclaredName name{std::string(ast.text(word)),
                      kind,
                      std::move(declaration),
                      comment_above(text, word.begin),
                      path,
                      word.begin,
                      word.end};
    if (!word.empty()) declared_.emplace(name.name, std::move(name));
  };
  for (const auto& statement : ast.statements()) {
    using Kind = compiler::StatementKind;
    const auto* items = ast.items(statement);
    if (statement.kind == Kind::kSort || statement.kind == Kind::kReifiedSort) {
      for (std::uint32_t i = 0; i < statement.item_count; ++i) {
        const auto parent = std::string(ast.text(items[i].parent));
        add(items[i].name, NameKind::kSort,
            "sort " + std::string(ast.text(items[i].name)) + (parent.empty() ? "" : ": " + parent));
      }
    } else if (statement.kind == Kind::kConstants) {
      for (std::uint32_t i = 0; i < statement.item_count; ++i) {
        add(items[i].name, NameKind::kConstant,
            std::string(ast.text(statement.sort)) + " " + std::string(ast.text(items[i].name)));
      }
    } else if (statement.kind == Kind::kConstructor) {
      add(statement.name, kind_of(ast.text(statement.sort)),
          std::string(ast.text(statement.source)));
    } else if (statement.kind == Kind::kFormula) {
      note_effects(ast, statement);
    }
  }
}

void NameMap::note_effects(const compiler::Ast& ast, const compiler::Statement& statement) {
  for (auto i = statement.first_node.index(); i <= statement.formula.index(); ++i) {
    const auto& node = ast[compiler::NodeId(i)];
    if (node.kind != compiler::NodeKind::kApply) continue;
    const auto name = ast.name(node);
    if (name != "Initiates" && name != "Terminates" && name != "Releases") continue;
    for (std::uint32_t k = 0; k < std::min(node.child_count, 2U); ++k) {
      const auto& term = ast[ast.child(node, k)];
      if (term.kind != compiler::NodeKind::kApply) continue;
      effects_.emplace_back(std::string(ast.name(term)), std::string(ast.text(statement.source)));
    }
  }
}

const DeclaredName* NameMap::resolve(std::string_view word) const {
  const auto found = declared_.find(word);
  if (found != declared_.end()) return &found->second;
  const auto sort = declared_.find(stem(word));
  return sort != declared_.end() && sort->second.kind == NameKind::kSort ? &sort->second : nullptr;
}

void NameMap::add_words(const std::string& path, const std::string& text) {
  auto& words = words_[path];
  const auto add = [&](std::size_t begin, std::size_t end) {
    const auto* name = resolve(std::string_view(text).substr(begin, end - begin));
    if (name != nullptr) words.push_back({begin, end, name->name});
  };
  const bool yaml = is_yaml(path);
  if (!yaml && !is_model(path) && !has_ending(path, ".bind")) return;
  // In models every name outside of comments is one of the language's; in tables and scenarios,
  // too, but for what is written for people.
  each_line(text, [&](std::size_t begin, std::string_view whole) {
    if (yaml && is_prose(whole)) return;
    const auto line = without_comment(whole, yaml);
    for (std::size_t i = 0; i < line.size();) {
      if (!is_word(line[i])) {
        ++i;
        continue;
      }
      auto end = i;
      while (end < line.size() && is_word(line[end])) ++end;
      // A variable of the table (?p), a part of a path or of a hyphenated word is no name of the
      // model.
      const char before = i == 0 ? ' ' : line[i - 1], after = end < line.size() ? line[end] : ' ';
      const bool is_part =
          before == '?' || (!is_model(path) && (before == '-' || before == '/' || before == '.' ||
                                                after == '-' || after == '/' || after == '.'));
      if (!is_part) add(begin + i, begin + end);
      i = end;
    }
  });
}

const DeclaredName* NameMap::at(const std::string& path, std::size_t offset) const {
  const auto found = words_.find(path);
  if (found == words_.end()) return nullptr;
  for (const auto& word : found->second) {
    if (word.begin <= offset && offset <= word.end) return &declared_.find(word.name)->second;
  }
  return nullptr;
}

std::vector<NamedPlace> NameMap::places(const DeclaredName& name) const {
  std::vector<NamedPlace> out;
  for (const auto& [path, words] : words_) {
    for (const auto& word : words) {
      if (word.name == name.name) out.push_back({path, word.begin, word.end});
    }
  }
  return out;
}

std::vector<std::string> NameMap::effects(const DeclaredName& name) const {
  std::vector<std::string> out;
  for (const auto& [of, axiom] : effects_) {
    if (of == name.name && (out.empty() || out.back() != axiom)) out.push_back(axiom);
  }
  return out;
}

}  // namespace parallax::tools::lsp
