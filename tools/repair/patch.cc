#include "tools/repair/patch.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <system_error>

#include "compiler/base/line_diff.h"
#include "compiler/base/shown_text.h"

namespace parallax::tools {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kContext = 3;

/// Lines with their ends.
std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> out;
  while (!text.empty()) {
    const auto end = text.find('\n');
    const auto size = end == std::string_view::npos ? text.size() : end + 1;
    out.push_back(text.substr(0, size));
    text.remove_prefix(size);
  }
  return out;
}

void add_line(char sign, std::string_view line, std::string& out) {
  out += sign;
  out += line;
  if (line.empty() || line.back() != '\n') out += "\n\\ No newline at end of file\n";
}

/// "3,7": from line 3 on seven lines. Of no lines the one in front is named.
std::string span(std::size_t begin, std::size_t end) {
  return fmt::format("{},{}", end == begin ? begin : begin + 1, end - begin);
}

std::string hunks(const std::string& before, const std::string& after) {
  const auto a = lines_of(before), b = lines_of(after);
  const auto changes = base::line_changes(a, b);
  std::string out;
  for (std::size_t first = 0; first < changes.size();) {
    auto last = first;
    while (last + 1 < changes.size() &&
           changes[last + 1].a_begin - changes[last].a_end <= 2 * kContext) {
      ++last;
    }
    const auto lead = std::min(changes[first].a_begin, kContext);
    const auto tail = std::min(a.size() - changes[last].a_end, kContext);
    out += fmt::format("@@ -{} +{} @@\n",
                       span(changes[first].a_begin - lead, changes[last].a_end + tail),
                       span(changes[first].b_begin - lead, changes[last].b_end + tail));
    auto at = changes[first].a_begin - lead;
    for (auto i = first; i <= last; ++i) {
      for (; at < changes[i].a_begin; ++at) add_line(' ', a[at], out);
      for (; at < changes[i].a_end; ++at) add_line('-', a[at], out);
      for (auto j = changes[i].b_begin; j < changes[i].b_end; ++j) add_line('+', b[j], out);
    }
    for (const auto end = at + tail; at < end; ++at) add_line(' ', a[at], out);
    first = last + 1;
  }
  return out;
}

/// Without links, so that a file has one name whatever the folder is called.
fs::path real_path(const fs::path& path) {
  std::error_code error;
  auto real = fs::weakly_canonical(path, error);
  return error ? path.lexically_normal() : real;
}

bool is_below(const fs::path& path, const fs::path& folder) {
  const auto name = path.lexically_relative(folder);
  return !name.empty() && *name.begin() != "..";
}

}  // namespace

std::vector<ChangedFile> changed_files(const base::SourceFiles& files,
                                       const std::vector<compiler::TextChange>& changes) {
  std::set<base::FileId> touched;
  for (const auto& change : changes) touched.insert(change.file);
  std::vector<ChangedFile> out;
  for (const auto file : touched) {
    const auto text = files[file].text();
    out.push_back(
        {files[file].name(), std::string(text), compiler::changed_text(text, file, changes)});
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return out;
}

std::string patch_folder(const std::vector<ChangedFile>& files, const fs::path& folder) {
  const auto here = real_path(folder);
  std::vector<fs::path> paths;
  for (const auto& file : files) paths.push_back(real_path(folder / file.name));
  const auto has_all = [&](const fs::path& top) {
    return std::all_of(paths.begin(), paths.end(),
                       [&](const fs::path& path) { return is_below(path, top); });
  };
  if (has_all(here)) return ".";
  std::error_code error;
  for (auto top = paths.front().parent_path(); top.has_relative_path(); top = top.parent_path()) {
    if (!fs::exists(top / ".git", error)) continue;
    if (has_all(top)) return top.lexically_relative(here).generic_string();
    break;
  }
  return "/";
}

std::string unified_diff(const std::vector<ChangedFile>& files, const fs::path& folder) {
  const auto top = real_path(folder / patch_folder(files, folder));
  std::string out;
  for (const auto& file : files) {
    const auto name =
        base::printable(real_path(folder / file.name).lexically_relative(top).generic_string());
    // git takes the text after a blank for a time, unless a tab ends the name.
    const auto* end = name.find(' ') == std::string::npos ? "\n" : "\t\n";
    out += "--- a/" + name + end + "+++ b/" + name + end + hunks(file.before, file.after);
  }
  return out;
}

std::string patch_folder(const std::vector<ChangedFile>& files) {
  std::error_code error;
  return patch_folder(files, fs::current_path(error));
}

std::string patch_from_here(const std::vector<ChangedFile>& files) {
  std::error_code error;
  return unified_diff(files, fs::current_path(error));
}

std::string patch_place_words(const std::vector<ChangedFile>& files) {
  const auto top = patch_folder(files);
  if (top == ".") return "";
  return fmt::format("The patch begins at {0}: `git -C {0} apply`, or `patch -p1 -d {0}`.", top);
}

}  // namespace parallax::tools
