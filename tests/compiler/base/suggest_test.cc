#include "compiler/base/suggest.h"

#include <doctest/doctest.h>

#include <vector>

namespace parallax::base {
namespace {

TEST_CASE("edit distance: insertions, deletions, substitutions and swaps of neighbours") {
  CHECK(edit_distance("", "") == 0);
  CHECK(edit_distance("abc", "abc") == 0);
  CHECK(edit_distance("abc", "ab") == 1);
  CHECK(edit_distance("abc", "axc") == 1);
  CHECK(edit_distance("abc", "acb") == 1);
  CHECK(edit_distance("kitten", "sitting") == 3);
  CHECK(edit_distance("", "abc") == 3);
}

TEST_CASE("nearest name: at most two edits away, the first of equals") {
  const std::vector<std::string> names = {"Filled", "Holding", "Hold", "At"};
  CHECK(nearest_name("Filed", names) == "Filled");
  CHECK(nearest_name("holding", names) == "Holding");
  CHECK_FALSE(nearest_name("Completely", names));
  CHECK_FALSE(nearest_name("On", names));  // every word of two letters is two edits from another
  CHECK_FALSE(nearest_name("x", {}));
}

TEST_CASE("nearest name: a name of a megabyte is compared with nothing") {
  const std::vector<std::string> names(1000, "Filled");
  CHECK_FALSE(nearest_name(std::string(1'000'000, 'x'), names));
}

}  // namespace
}  // namespace parallax::base
