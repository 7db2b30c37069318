#include "compiler/base/shown_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "compiler/base/ascii.h"
#include "compiler/base/utf8.h"

namespace parallax::base {
namespace {

bool is_direction_mark(char32_t c) {
  return (c >= 0x202A && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069) || c == 0x200E ||
         c == 0x200F || c == 0x061C || c == 0xFEFF;
}

/// Blanks that CI systems skip in front of a command.
bool is_blank(char32_t c) {
  return c == ' ' || c == '\t' || c == 0xA0 || c == 0x1680 || (c >= 0x2000 && c <= 0x200B) ||
         c == 0x202F || c == 0x205F || c == 0x3000;
}

std::string escaped(char32_t c) { return fmt::format("\\u{:04x}", static_cast<std::uint32_t>(c)); }

/// The code point at the front, escaped if it steers a display or is no UTF-8.
void append_printable(std::string_view text, const CodePoint& point, std::string& out) {
  if (!point.valid) {
    out += fmt::format("\\x{:02x}", static_cast<unsigned>(static_cast<unsigned char>(text[0])));
  } else if (steers_display(point.value)) {
    out += escaped(point.value);
  } else {
    out.append(text.substr(0, point.length));
  }
}

/// The length of the colour that the program itself sets at the front of `text`, else 0.
std::size_t own_color(std::string_view text) {
  constexpr std::array<std::string_view, 5> kOwn = {"\x1b[0m", "\x1b[31m", "\x1b[1;31m",
                                                    "\x1b[1;32m", "\x1b[1;33m"};
  for (const auto one : kOwn) {
    if (text.starts_with(one)) return one.size();
  }
  return 0;
}

/// `##[error]`, `##vso[` and `##teamcity[` are read as commands anywhere in a line.
bool begins_bracket_command(std::string_view text) {
  if (!text.starts_with("##")) return false;
  const auto end = std::find_if_not(text.begin() + 2, text.end(), is_letter);
  return end != text.end() && *end == '[';
}

/// The length of the beginning that needs no look at it: most of most texts.
std::size_t plain_length(std::string_view text) {
  const auto is_plain = [](char c) { return c >= ' ' && c < '\x7f' && c != '#'; };
  return static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), is_plain) -
                                  text.begin());
}

std::string gated(std::string_view text, bool commands, bool colors) {
  std::string out;
  out.reserve(text.size());
  bool at_start = true;  // of a line, but for blanks
  while (!text.empty()) {
    const auto plain = at_start ? std::min(text.find_first_not_of(' '), text.size())  // indentation
                                : plain_length(text);
    if (plain > 0) {
      out.append(text.substr(0, plain));
      text.remove_prefix(plain);
      continue;
    }
    const auto point = front_code_point(text);
    std::size_t length = point.valid ? point.length : 1;
    const auto own = colors && text.front() == '\x1b' ? own_color(text) : 0;
    const bool ends_line = text.front() == '\n' || text.starts_with("\r\n");
    const bool is_command = !commands && ((at_start && text.starts_with("::")) ||
                                          (text.front() == '#' && begins_bracket_command(text)));
    if (own > 0) {
      length = own;
      out.append(text.substr(0, length));
    } else if (is_command) {
      // Escape the second `#` of `##vso[`, since another `#` may stand before the first.
      if (text.front() == '#') out += '#', length = 2;
      out += escaped(static_cast<unsigned char>(text.front()));
    } else if (ends_line || text.front() == '\t') {
      out += text.front();
    } else {
      append_printable(text, point, out);
    }
    at_start = ends_line || (at_start && (own > 0 || (point.valid && is_blank(point.value))));
    text.remove_prefix(length);
  }
  return out;
}

/// Decimal, infinite or NaN: a spreadsheet reads it as a number or a word, never as a formula.
bool is_number(std::string_view text) {
  if (text.starts_with('+') || text.starts_with('-')) text.remove_prefix(1);
  if (text == "inf" || text == "nan") return true;
  const auto take_digits = [&] {
    const auto end = std::find_if_not(text.begin(), text.end(), is_digit);
    const auto count = static_cast<std::size_t>(end - text.begin());
    text.remove_prefix(count);
    return count;
  };
  auto digits = take_digits();
  if (text.starts_with('.')) {
    text.remove_prefix(1);
    digits += take_digits();
  }
  if (digits == 0) return false;
  if (text.starts_with('e') || text.starts_with('E')) {
    text.remove_prefix(1);
    if (text.starts_with('+') || text.starts_with('-')) text.remove_prefix(1);
    if (take_digits() == 0) return false;
  }
  return text.empty();
}

/// Signs that begin a formula, also their wide forms, and blanks that are dropped before one.
bool begins_formula(std::string_view text) {
  if (text.empty()) return false;
  const auto c = front_code_point(text).value;
  constexpr std::u32string_view kSigns = U"=+-@\t\r\n\uFF1D\uFF0B\uFF0D\uFF20";
  return kSigns.find(c) != std::u32string_view::npos && !is_number(text);
}

}  // namespace

bool steers_display(char32_t c) {
  return c < 0x20 || (c >= 0x7F && c < 0xA0) || c == 0x2028 || c == 0x2029 || is_direction_mark(c);
}

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const auto point = front_code_point(text);
    append_printable(text, point, out);
    text.remove_prefix(point.valid ? point.length : 1);
  }
  return out;
}

std::string shown_lines(std::string_view text, const LinesStyle& style) {
  return gated(text, style.commands, style.colors);
}

std::string shown_markup(std::string_view text) { return gated(text, true, false); }

std::string shown(std::string_view text, TextForm form) {
  if (form == TextForm::kExact) return std::string(text);
  return form == TextForm::kMarkup ? shown_markup(text) : shown_lines(text);
}

std::string csv_cell(std::string_view text) {
  auto plain = (begins_formula(text) ? "'" : "") + printable(text);
  if (plain.find_first_of(",\"") == std::string::npos) return plain;
  std::string out = "\"";
  for (const char c : plain) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

}  // namespace parallax::base
