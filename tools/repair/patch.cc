#include "tools/repair/patch.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "compiler/base/line_diff.h"

namespace parallax::tools {
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

std::string unified_diff(const std::vector<ChangedFile>& files, const std::string& folder) {
  std::string out;
  for (const auto& file : files) {
    const auto path = std::filesystem::path(file.name).lexically_normal();
    auto name = path.generic_string();
    if (path.is_absolute()) {
      const auto below = path.lexically_relative(folder).generic_string();
      name = below.empty() || below.starts_with("..") ? name.substr(1) : below;
    }
    out += "--- a/" + name + "\n+++ b/" + name + "\n" + hunks(file.before, file.after);
  }
  return out;
}

}  // namespace parallax::tools
