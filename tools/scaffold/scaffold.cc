#include "tools/scaffold/scaffold.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "tools/scaffold/templates.h"

namespace parallax::tools {
namespace {

constexpr std::size_t kLongestName = 64;

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

}  // namespace

const std::vector<ScaffoldKind>& scaffold_kinds() {
  static const std::vector<ScaffoldKind> kinds = {
      {"line", "line"}, {"room", "mobile"}, {"kitchen", "mobile"}};
  return kinds;
}

std::string wrong_scenario_name(std::string_view name) {
  const auto is_fit = [](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  if (!name.empty() && name.size() <= kLongestName && is_letter(name.front()) &&
      std::all_of(name.begin(), name.end(), is_fit)) {
    return {};
  }
  return fmt::format(
      "a scenario has up to {} letters, digits, `_` and `-` as its name, a letter first",
      kLongestName);
}

std::vector<ScaffoldFile> scaffold_files(std::string_view name, const ScaffoldKind& kind) {
  std::vector<ScaffoldFile> files;
  for (const auto& file : template_files()) {
    const auto slash = file.path.find('/');
    const bool shared = slash == std::string_view::npos;
    const auto folder = shared ? std::string_view() : file.path.substr(0, slash);
    if (!shared && folder != kind.world && folder != kind.robot) continue;
    files.push_back({std::string(shared ? file.path : file.path.substr(slash + 1)),
                     with_mark(std::string(file.text), "NAME", name)});
  }
  std::sort(files.begin(), files.end(),
            [](const ScaffoldFile& a, const ScaffoldFile& b) { return a.name < b.name; });
  return files;
}

std::string with_mark(std::string text, std::string_view mark, std::string_view value) {
  const std::string marked = fmt::format("@{}@", mark);
  for (std::size_t at = 0; (at = text.find(marked, at)) != std::string::npos; at += value.size()) {
    text.replace(at, marked.size(), value);
  }
  return text;
}

base::Status write_scaffold_file(const std::filesystem::path& folder, const ScaffoldFile& file,
                                 const base::SourceFiles& read, base::DiagnosticSink& sink) {
  const auto path = folder / file.name;
  std::error_code ignored;  // the file itself says why it cannot be written
  std::filesystem::create_directories(path.parent_path(), ignored);
  return base::write_output(path.string(), file.text, read, sink, base::TextForm::kExact);
}

base::Status write_scaffold(const std::string& folder, const std::vector<ScaffoldFile>& files,
                            const base::SourceFiles& read, base::DiagnosticSink& sink) {
  if (::mkdir(folder.c_str(), 0777) != 0) {
    if (errno == EEXIST) {
      return sink.error_about(codes::kUsage, folder,
                              "it is there already, and nothing is replaced; choose another name");
    }
    return sink.error_about(codes::kFileNotWritable, folder, std::strerror(errno));
  }
  for (const ScaffoldFile& file : files) {
    if (write_scaffold_file(folder, file, read, sink)) continue;
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);  // it is all of our own making
    return sink.already_reported();
  }
  return base::Unit{};
}

}  // namespace parallax::tools
