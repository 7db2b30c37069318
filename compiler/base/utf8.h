#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace parallax::base {

/// What stands at the front of a text.
struct CodePoint {
  char32_t value = 0;      // of a valid one
  std::size_t length = 1;  // in bytes; of what is no UTF-8, how much of it one U+FFFD stands for
  bool valid = false;
};

/// The code point at the front of `text`, which must not be empty. Overlong forms, surrogates, what
/// is beyond U+10FFFF and what is cut off are not valid (The Unicode Standard 15.0, table 3-7).
CodePoint front_code_point(std::string_view text);

/// The offset of the first byte that does not belong to a valid code point; `text.size()` if all
/// do.
std::size_t first_invalid_utf8(std::string_view text);

/// Is `byte` one that goes on with a code point, rather than the first of one?
constexpr bool continues_code_point(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

/// How many code points begin in `text`; in what is no UTF-8, bytes that could begin one count.
std::size_t count_code_points(std::string_view text);

/// `text`, with U+FFFD for what is no UTF-8: one for each longest start of a valid code point, one
/// for each other byte (The Unicode Standard 15.0, section 3.9).
std::string with_invalid_utf8_replaced(std::string_view text);

}  // namespace parallax::base
