#include "compiler/base/words.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <optional>
#include <stdexcept>

#include "compiler/base/word_table.h"

namespace parallax::base {
namespace {

TEST_CASE("a noun agrees with its count") {
  CHECK(counted(0, "run") == "0 runs");
  CHECK(counted(1, "run") == "1 run");
  CHECK(counted(2, "run") == "2 runs");
  CHECK(counted(1, "box", "boxes") == "1 box");
  CHECK(counted(-1, "box", "boxes") == "-1 boxes");
  CHECK(agreed(1, "is", "are") == "is");
  CHECK(agreed(0, "is", "are") == "are");
}

TEST_CASE("names are enumerated with a last word") {
  CHECK(listed({}).empty());
  CHECK(listed({"a"}) == "a");
  CHECK(listed({"a", "b"}) == "a and b");
  CHECK(listed({"a", "b", "c"}, "or") == "a, b or c");
}

TEST_CASE("white space becomes single blanks") {
  CHECK(one_line("") == "");
  CHECK(one_line(" \n\t ") == "");
  CHECK(one_line("  a\r\n  b\tc  ") == "a b c");
}

enum class Colour : std::uint8_t { kRed, kDeepBlue };
constexpr auto kColours = word_table<Colour>("red", "deep-blue");
static_assert(kColours.of(Colour::kDeepBlue) == "deep-blue");

TEST_CASE("a table of words goes both ways") {
  CHECK(kColours.find("red") == Colour::kRed);
  CHECK_FALSE(kColours.find("blue"));
  auto colour = Colour::kRed;
  std::optional<Colour> none;
  kColours.take("deep-blue", colour);
  CHECK(colour == Colour::kDeepBlue);
  kColours.take("blue", colour);
  CHECK(colour == Colour::kDeepBlue);
  kColours.take("blue", none);
  CHECK_FALSE(none);
  kColours.take("red", none);
  CHECK(none == Colour::kRed);
}

TEST_CASE("a value without a word is refused") {
  CHECK_THROWS_AS(kColours.of(static_cast<Colour>(2)), std::out_of_range);
}

}  // namespace
}  // namespace parallax::base
