#include "compiler/base/markdown.h"

#include <algorithm>

#include "compiler/base/ascii.h"
#include "compiler/base/shown_text.h"

namespace parallax::base {

std::string markdown_text(std::string_view text) {
  // A table's cell ends with its line.
  std::string line(text);
  std::replace_if(line.begin(), line.end(), is_space, ' ');
  std::string out;
  for (const char c : printable(line)) {
    if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '&') {
      out += "&amp;";
    } else if (c == '@') {
      out += "&#64;";  // names nobody
    } else {
      if (std::string_view(R"(\`*_{}[]()#+-.!|~$:)").find(c) != std::string_view::npos) out += '\\';
      out += c;
    }
  }
  return out;
}

std::string markdown_block(std::string_view text) {
  auto shown = shown_lines(text);
  std::size_t ticks = 0, longest = 2;
  for (const char c : shown) {
    ticks = c == '`' ? ticks + 1 : 0;
    longest = std::max(longest, ticks);
  }
  if (!shown.ends_with('\n')) shown += '\n';
  const std::string fence(longest + 1, '`');
  return fence + "text\n" + shown + fence + '\n';
}

}  // namespace parallax::base
