#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace parallax::base {

/// The code point at the front of a text.
struct CodePoint {
  char32_t value = 0;      // only if valid
  std::size_t length = 1;  // in bytes; for invalid UTF-8, those that one U+FFFD replaces
  bool valid = false;
};

/// The code point at the front of `text`, which must not be empty. Overlong forms, surrogates,
/// values beyond U+10FFFF and truncated sequences are not valid (The Unicode Standard 15.0, table
/// 3-7).
CodePoint front_code_point(std::string_view text);

/// The offset of the first byte that does not belong to a valid code point; `text.size()` if all
/// do.
std::size_t first_invalid_utf8(std::string_view text);

/// Is `byte` a continuation byte rather than the first byte of a code point?
constexpr bool continues_code_point(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

/// The number of code points that begin in `text`; in invalid UTF-8, each byte that could begin one
/// counts.
std::size_t count_code_points(std::string_view text);

/// `text` with invalid UTF-8 replaced by U+FFFD: one for each longest start of a valid code point,
/// one for each other byte (The Unicode Standard 15.0, section 3.9).
std::string with_invalid_utf8_replaced(std::string_view text);

}  // namespace parallax::base
