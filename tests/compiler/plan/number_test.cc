#include "compiler/lisp/number.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>

namespace parallax::compiler {
namespace {

Number read(std::string_view token) {
  Number out;
  REQUIRE(Number::parse(token, out) == Number::Parse::kNumber);
  return out;
}

TEST_CASE("number: decimals and ratios are exact rationals") {
  CHECK(read("0.1") + read("0.2") == read("0.3"));
  CHECK(compare(read("3/4"), read("0.75d0")) == 0);
  CHECK(read("-0.2") == Number::ratio(-1, 5)->as_float());
  CHECK(read("1e-3") == Number::ratio(1, 1000)->as_float());
  CHECK(read("6/4").to_string() == "3/2");
  CHECK(read("+5") == Number(5));
  CHECK(read("1.").is_integer());
  CHECK(read(".5").value() == 0.5);
  CHECK(read("12e2") == Number(1200).as_float());
}

TEST_CASE("number: a float is no rational, whatever its value") {
  CHECK_FALSE(read("1.0") == read("1"));
  CHECK(read("1.") == read("1"));
  CHECK(compare(read("0.5"), read("1/2")) == 0);
  CHECK((read("1/2") + read("1/2")) == Number(1));
  CHECK((read("0.5") + read("1/2")) == Number(1).as_float());
  CHECK(divide(read("1.0"), read("2"))->is_float());
  CHECK_FALSE(read("1.0") == read("1.0d0"));
  CHECK(read("1f0") == read("1.0"));
  CHECK(read("1l0") == read("1.0D0"));
  CHECK(compare(read("1.0"), read("1.0d0")) == 0);
  CHECK((read("1") + read("2.5d0")) == read("3.5d0"));
  CHECK((read("0.5") * read("2d0")) == read("1d0"));
  CHECK(divide(read("1d0"), read("4.0")) == read("0.25d0"));
  CHECK((read("1d300") * read("3")).kind() == Number::Kind::kDouble);
  for (const std::string token : {"1.0", "-0.2", "1e3", "0.75d0", "1d30", "1e30", "12.5", "1/3"}) {
    CAPTURE(token);
    CHECK(read(read(token).to_string()) == read(token));
  }
}

TEST_CASE("number: what does not fit 64 bits becomes a double") {
  const auto big = read("123456789012345678901234567890");
  CHECK_FALSE(big.exact());
  CHECK(big.value() == 123456789012345678901234567890.0);
  const auto product = Number(std::int64_t{1} << 62) * Number(4);
  CHECK_FALSE(product.exact());
  CHECK(product.value() == std::ldexp(1.0, 64));
  CHECK(read("1e-400").value() == 0.0);
  Number out;
  CHECK(Number::parse("1e400", out) == Number::Parse::kOutOfRange);
  CHECK(Number::parse("1/0", out) == Number::Parse::kZeroDenominator);
}

TEST_CASE("number: the smallest integer does not overflow") {
  const Number lowest(std::numeric_limits<std::int64_t>::min());
  CHECK((Number(0) - lowest).value() == std::ldexp(1.0, 63));
  CHECK(divide(Number(1), lowest)->value() == -std::ldexp(1.0, -63));
  CHECK(compare(lowest, Number(0)) == -1);
  CHECK((lowest + Number(-1)).value() == -std::ldexp(1.0, 63));
}

TEST_CASE("number: other tokens are no numbers") {
  Number out;
  for (const std::string token : {"", "+", "-", ".", "1+", "1-", "e5", "1e", "1/2/3", "1.5.2", "a1",
                                  "1/", "/2", "+-1", "+-1/2", "--1/2", "1e+-5"}) {
    CAPTURE(token);
    CHECK(Number::parse(token, out) == Number::Parse::kNotANumber);
  }
}

TEST_CASE("number: comparison is exact where both numbers are") {
  CHECK(compare(*Number::ratio(1, 3), *Number::ratio(333333333, 1000000000)) == 1);
  CHECK(compare(read("0.5"), *Number::ratio(1, 2)) == 0);
  CHECK(compare(Number::inexact(0.5), Number(1)) == -1);
  CHECK_FALSE(divide(Number(1), Number(0)).has_value());
}

}  // namespace
}  // namespace parallax::compiler
