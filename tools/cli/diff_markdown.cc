#include "tools/cli/diff_markdown.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/base/file_io.h"
#include "compiler/base/shown_text.h"
#include "tools/cli/replaceable.h"

namespace parallax::tools {
namespace {

// The first line, by which such a file is known again.
constexpr std::string_view kDiffMark = "<!-- parallax diff -->";

bool is_ours(std::string_view head) { return head.starts_with(kDiffMark); }

/// Within a line of prose no character of the text is markup.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : base::printable(text)) {
    if (std::string_view("\\`*_{}[]<>#|").find(c) != std::string_view::npos) out += '\\';
    out += c;
  }
  return out;
}

/// A fence that no line of the text can end.
std::string fence_for(std::string_view text) {
  std::size_t longest = 0, ticks = 0;
  for (const char c : text) {
    ticks = c == '`' ? ticks + 1 : 0;
    longest = std::max(longest, ticks);
  }
  return std::string(std::max<std::size_t>(3, longest + 1), '`');
}

}  // namespace

std::string diff_markdown(const DiffMarkdown& difference) {
  const std::string_view text = difference.text;
  const auto fence = fence_for(text);
  auto out = fmt::format("{}\n## {} and {}\n", kDiffMark, escaped(difference.old_name),
                         escaped(difference.new_name));
  bool inside = false;
  for (std::size_t begin = 0; begin < text.size();) {
    const auto end = std::min(text.find('\n', begin), text.size());
    auto line = text.substr(begin, end - begin);
    begin = end + 1;
    const bool is_block = line.starts_with("  ");
    if (is_block != inside) out += is_block ? fmt::format("\n{}diff\n", fence) : fence + '\n';
    inside = is_block;
    if (is_block) {
      out += base::printable(line.substr(2)) + '\n';
    } else if (!line.empty()) {
      out += '\n' + escaped(line) + '\n';
    }
  }
  if (inside) out += fence + '\n';
  return out;
}

base::Status may_write_diff_markdown(const std::string& file, Invocation& invocation) {
  if (file.empty()) return base::Unit{};
  return check_replaceable(file, is_ours, invocation.files(), invocation.sink());
}

base::Status write_diff_markdown(const DiffMarkdown& difference, Invocation& invocation) {
  if (difference.file.empty()) return base::Unit{};
  return base::write_output(difference.file, diff_markdown(difference), invocation.files(),
                            invocation.sink());
}

}  // namespace parallax::tools
