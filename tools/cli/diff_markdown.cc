#include "tools/cli/diff_markdown.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/base/shown_text.h"

namespace parallax::tools {
namespace {

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

std::string diff_markdown(const std::string& old_name, const std::string& new_name,
                          std::string_view text) {
  const auto fence = fence_for(text);
  auto out = fmt::format("{}\n## {} and {}\n", kDiffMark, escaped(old_name), escaped(new_name));
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

}  // namespace parallax::tools
