#include "tools/repair/scenario_copy.h"

#include <algorithm>
#include <system_error>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/file_io.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

std::string absolute_name(const std::string& name) {
  std::error_code error;
  return fs::absolute(name, error).lexically_normal().generic_string();
}

/// The folder that all of them lie in.
fs::path common_folder(const std::map<std::string, std::string>& files) {
  fs::path out;
  for (const auto& [name, text] : files) {
    const auto folder = fs::path(name).parent_path();
    if (out.empty()) {
      out = folder;
      continue;
    }
    fs::path both;
    for (auto a = out.begin(), b = folder.begin(); a != out.end() && b != folder.end() && *a == *b;
         ++a, ++b) {
      both /= *a;
    }
    out = both;
  }
  return out;
}

}  // namespace

base::Result<ScenarioCopy> ScenarioCopy::make(const fs::path& scenario, const fs::path& folder,
                                              std::size_t first_file, std::size_t first_input,
                                              Context& context) {
  auto& sink = context.sink();
  const auto& files = context.files();
  std::map<std::string, std::string> texts;
  std::map<std::string, std::string> names;  // as they are told
  const auto add = [&](const std::string& name) -> base::Status {
    std::error_code error;
    const auto place = absolute_name(name);
    if (texts.contains(place) || !fs::is_regular_file(name, error)) return base::Unit{};
    auto text = base::read_file(name, sink);
    if (!text) return sink.already_reported();
    texts.emplace(place, *std::move(text));
    names.emplace(place, name);
    return base::Unit{};
  };
  for (auto i = first_file; i < files.size(); ++i) {
    if (!add(files[base::FileId(static_cast<std::uint32_t>(i))].name())) {
      return sink.already_reported();
    }
  }
  for (auto i = first_input; i < files.inputs().size(); ++i) {
    if (!add(files.inputs()[i])) return sink.already_reported();
  }
  const auto root = common_folder(texts);
  ScenarioCopy out;
  for (const auto& [place, text] : texts) {
    const auto target = folder / fs::path(place).lexically_relative(root);
    std::error_code error;
    fs::create_directories(target.parent_path(), error);
    if (!base::write_file_atomically(target, text, sink)) return sink.already_reported();
    out.copies_.emplace(names.at(place), std::pair(target, text));
  }
  out.scenario_ = folder / fs::path(absolute_name(scenario.string())).lexically_relative(root);
  return out;
}

base::Result<std::vector<ChangedFile>> ScenarioCopy::changes(Context& context) const {
  std::vector<ChangedFile> out;
  for (const auto& [name, copy] : copies_) {
    auto now = base::read_file(copy.first, context.sink());
    if (!now) return context.sink().already_reported();
    if (*now != copy.second) out.push_back({name, copy.second, *std::move(now)});
  }
  return out;
}

}  // namespace parallax::tools
