#include "compiler/base/ascii.h"

#include <doctest/doctest.h>

#include <cctype>
#include <cstdint>
#include <limits>

#include "compiler/base/whole_number.h"

namespace parallax::base {
namespace {

TEST_CASE("kinds of characters are those of the C locale, for every byte") {
  for (int byte = 0; byte < 256; ++byte) {
    CAPTURE(byte);
    const char c = static_cast<char>(byte);
    const bool ascii = byte < 128;
    CHECK(is_digit(c) == (ascii && std::isdigit(byte) != 0));
    CHECK(is_lower(c) == (ascii && std::islower(byte) != 0));
    CHECK(is_upper(c) == (ascii && std::isupper(byte) != 0));
    CHECK(is_letter(c) == (ascii && std::isalpha(byte) != 0));
    CHECK(is_name_character(c) == (ascii && (std::isalnum(byte) != 0 || c == '_')));
    CHECK(is_space(c) == (ascii && std::isspace(byte) != 0 && c != '\f' && c != '\v'));
    CHECK(to_lower(c) == (ascii ? static_cast<char>(std::tolower(byte)) : c));
    CHECK(to_upper(c) == (ascii ? static_cast<char>(std::toupper(byte)) : c));
  }
}

TEST_CASE("identifiers begin with a letter or `_`") {
  CHECK(is_identifier("a"));
  CHECK(is_identifier("_1"));
  CHECK(is_identifier("bTable2"));
  CHECK_FALSE(is_identifier(""));
  CHECK_FALSE(is_identifier("2b"));
  CHECK_FALSE(is_identifier("a b"));
  CHECK_FALSE(is_identifier("caf\xC3\xA9"));
}

TEST_CASE("a text of nothing but space") {
  CHECK(is_all_space(""));
  CHECK(is_all_space(" \t\r\n"));
  CHECK_FALSE(is_all_space("  x "));
}

TEST_CASE("a whole number is the whole text") {
  CHECK(whole_number<int>("7") == 7);
  CHECK(whole_number<int>("-7") == -7);
  CHECK(whole_number<int>("007") == 7);
  CHECK(whole_number<std::uint64_t>("ff", 16) == 255);
  for (const auto* text : {"", "-", "+7", " 7", "7 ", "7.0", "0x7", "seven", "7e1"}) {
    CAPTURE(text);
    CHECK_FALSE(whole_number<int>(text));
  }
  CHECK_FALSE(whole_number<std::uint32_t>("-1"));
}

TEST_CASE("a number that does not fit is none") {
  CHECK(whole_number<std::int64_t>("-9223372036854775808") ==
        std::numeric_limits<std::int64_t>::min());
  CHECK_FALSE(whole_number<std::int64_t>("9223372036854775808"));
  CHECK_FALSE(whole_number<std::uint8_t>("256"));
}

}  // namespace
}  // namespace parallax::base
