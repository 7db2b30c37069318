#include "compiler/base/xml_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "compiler/base/shown_text.h"
#include "compiler/base/utf8.h"

namespace parallax::base {
namespace {

/// The length of the code point at the front, or 0 if XML 1.0 cannot hold it.
std::size_t character_length(std::string_view text) {
  const auto point = front_code_point(text);
  const auto c = point.value;
  const bool control = c < 0x20 && c != '\t' && c != '\n';
  return !point.valid || control || c == 0xFFFE || c == 0xFFFF ? 0 : point.length;
}

std::string_view entity(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&apos;";
    case '\t':
      return "&#9;";
    case '\n':
      return "&#10;";
    default:
      return {};
  }
}

}  // namespace

std::string xml_escaped(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const auto length = character_length(text);
    if (text.front() == '\r') {
      out += "&#13;";
    } else if (const auto point = front_code_point(text);
               point.valid && point.value >= 0x7F && steers_display(point.value)) {
      out += fmt::format("\\u{:04X}", static_cast<std::uint32_t>(point.value));
    } else if (length == 0) {
      out += fmt::format("\\x{:02X}", static_cast<unsigned>(static_cast<unsigned char>(text[0])));
    } else if (const auto known = entity(text.front()); !known.empty()) {
      out += known;
    } else {
      out += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return out;
}

}  // namespace parallax::base
