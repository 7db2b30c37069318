#include "compiler/base/utf8.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <nlohmann/json.hpp>

namespace parallax::base {
namespace {

TEST_CASE("code points are read at the limits of each length") {
  struct Known {
    std::string_view bytes;
    char32_t value;
  };
  for (const auto& known :
       {Known{{"\0", 1}, 0}, Known{"\x7F", 0x7F}, Known{"\xC2\x80", 0x80}, Known{"\xDF\xBF", 0x7FF},
        Known{"\xE0\xA0\x80", 0x800}, Known{"\xED\x9F\xBF", 0xD7FF}, Known{"\xEE\x80\x80", 0xE000},
        Known{"\xEF\xBF\xBF", 0xFFFF}, Known{"\xF0\x90\x80\x80", 0x10000},
        Known{"\xF4\x8F\xBF\xBF", 0x10FFFF}}) {
    const auto point = front_code_point(std::string(known.bytes) + "x");
    CHECK(point.valid);
    CHECK(point.value == known.value);
    CHECK(point.length == known.bytes.size());
    CHECK(first_invalid_utf8(known.bytes) == known.bytes.size());
  }
}

TEST_CASE("overlong forms, surrogates, what is too large and what is cut off are no UTF-8") {
  for (const std::string_view bad : {"\x80",
                                     "\xBF",
                                     "\xC0\x80",
                                     "\xC1\xBF",
                                     "\xE0\x80\x80",
                                     "\xE0\x9F\xBF",
                                     "\xED\xA0\x80",
                                     "\xED\xBF\xBF",
                                     "\xF0\x80\x80\x80",
                                     "\xF0\x8F\xBF\xBF",
                                     "\xF4\x90\x80\x80",
                                     "\xF5\x80\x80\x80",
                                     "\xFE",
                                     "\xFF",
                                     "\xC3",
                                     "\xE2\x82",
                                     "\xF0\x9F\x8E",
                                     "\xC3(",
                                     "\xE2(\x82",
                                     "\xE2\x82(",
                                     "\xF0\x9F\x8E("}) {
    CAPTURE(bad);
    CHECK_FALSE(front_code_point(bad).valid);
    CHECK(first_invalid_utf8("a\xC3\xA9" + std::string(bad)) == 3);
  }
}

TEST_CASE("code points are counted, in invalid text by the bytes that could begin one") {
  CHECK(count_code_points("") == 0);
  CHECK(count_code_points("caf\xC3\xA9 \xE2\x82\xAC") == 6);
  CHECK(count_code_points("\xC3\xC3\xA9") == 2);
  CHECK(count_code_points("\x80\x80") == 0);
  CHECK(continues_code_point('\xA9'));
  CHECK_FALSE(continues_code_point('a'));
  CHECK_FALSE(continues_code_point('\xC3'));
}

TEST_CASE("what is no UTF-8 is replaced by the longest stretches") {
  const std::string mark = "\xEF\xBF\xBD";
  CHECK(with_invalid_utf8_replaced("plain \xE2\x82\xAC") == "plain \xE2\x82\xAC");
  CHECK(with_invalid_utf8_replaced("a\xFF"
                                   "b") == "a" + mark + "b");
  CHECK(with_invalid_utf8_replaced("\xE2\x82"
                                   "b") == mark + "b");
  CHECK(with_invalid_utf8_replaced("\xE2\x82") == mark);
  CHECK(with_invalid_utf8_replaced("\xED\xA0\x80") == mark + mark + mark);
  CHECK(with_invalid_utf8_replaced("\xF0\x9F\x8E\xC3\xA9") == mark + "\xC3\xA9");
}

TEST_CASE("replacement agrees with what JSON texts of the same bytes become") {
  constexpr std::string_view kBytes = "a\x80\xA0\xBF\x90\x9F\xC2\xE0\xED\xEF\xF0\xF4\xF5";
  std::uint32_t state = 20261;
  for (int round = 0; round < 20000; ++round) {
    std::string text;
    for (int i = 0; i < 8; ++i) {
      state = state * 1664525U + 1013904223U;
      text += kBytes[(state >> 16U) % kBytes.size()];
    }
    const auto replace = nlohmann::json::error_handler_t::replace;
    const std::string other =
        nlohmann::json::parse(nlohmann::json(text).dump(-1, ' ', false, replace));
    CAPTURE(nlohmann::json(other).dump());
    REQUIRE(with_invalid_utf8_replaced(text) == other);
  }
}

}  // namespace
}  // namespace parallax::base
