#include "compiler/base/markdown.h"

#include <algorithm>

namespace parallax::base {

std::string markdown_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7F) {
      out += ' ';
    } else if (c == '<') {
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
  std::string shown;
  std::size_t ticks = 0, longest = 2;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    ticks = c == '`' ? ticks + 1 : 0;
    longest = std::max(longest, ticks);
    shown += (byte < 0x20 && c != '\n') || byte == 0x7F ? ' ' : c;
  }
  if (!shown.ends_with('\n')) shown += '\n';
  const std::string fence(longest + 1, '`');
  return fence + "text\n" + shown + fence + '\n';
}

}  // namespace parallax::base
