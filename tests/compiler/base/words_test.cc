#include "compiler/base/words.h"

#include <doctest/doctest.h>

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

}  // namespace
}  // namespace parallax::base
