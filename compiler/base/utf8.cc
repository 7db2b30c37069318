#include "compiler/base/utf8.h"

#include <algorithm>

#include "compiler/base/contract.h"

namespace parallax::base {
namespace {

/// The shape of the code points that begin with one byte. The second byte has bounds of its own:
/// they exclude overlong forms, surrogates and values beyond U+10FFFF.
struct Shape {
  std::size_t length = 0;  // 0: no code point begins with this byte
  unsigned char second_low = 0x80, second_high = 0xBF;
};

Shape shape_of(unsigned char lead) {
  if (lead < 0x80) return {1};
  if (lead < 0xC2) return {};
  if (lead < 0xE0) return {2};
  if (lead == 0xE0) return {3, 0xA0, 0xBF};
  if (lead == 0xED) return {3, 0x80, 0x9F};
  if (lead < 0xF0) return {3};
  if (lead == 0xF0) return {4, 0x90, 0xBF};
  if (lead < 0xF4) return {4};
  if (lead == 0xF4) return {4, 0x80, 0x8F};
  return {};
}

}  // namespace

CodePoint front_code_point(std::string_view text) {
  PARALLAX_REQUIRE(!text.empty(), "a code point is read from a text that is not empty");
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const auto shape = shape_of(byte(0));
  if (shape.length == 0) return {};
  if (shape.length == 1) return {byte(0), 1, true};
  char32_t value = byte(0) & (0x7FU >> shape.length);
  for (std::size_t i = 1; i < shape.length; ++i) {
    const unsigned char low = i == 1 ? shape.second_low : 0x80;
    const unsigned char high = i == 1 ? shape.second_high : 0xBF;
    if (i == text.size() || byte(i) < low || byte(i) > high) return {0, i, false};
    value = (value << 6U) | (byte(i) & 0x3FU);
  }
  return {value, shape.length, true};
}

std::size_t first_invalid_utf8(std::string_view text) {
  std::size_t i = 0;
  while (i < text.size()) {
    const auto point = front_code_point(text.substr(i));
    if (!point.valid) break;
    i += point.length;
  }
  return i;
}

std::size_t count_code_points(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return !continues_code_point(c); }));
}

std::string with_invalid_utf8_replaced(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const auto point = front_code_point(text);
    out += point.valid ? text.substr(0, point.length) : std::string_view("\xEF\xBF\xBD");
    text.remove_prefix(point.length);
  }
  return out;
}

}  // namespace parallax::base
