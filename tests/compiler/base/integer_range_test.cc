#include "compiler/base/integer_range.h"

#include <doctest/doctest.h>

#include <limits>
#include <vector>

namespace parallax::test {
namespace {

constexpr auto kLeast = std::numeric_limits<std::int64_t>::min();
constexpr auto kMost = std::numeric_limits<std::int64_t>::max();

std::vector<std::int64_t> listed(std::int64_t first, std::int64_t last) {
  std::vector<std::int64_t> out;
  for (const auto i : base::IntegerRange(first, last)) {
    out.push_back(i);
    if (out.size() > 10) break;
  }
  return out;
}

using Numbers = std::vector<std::int64_t>;

TEST_CASE("a range has both of its ends, and none if they are reversed") {
  CHECK(listed(-1, 2) == Numbers{-1, 0, 1, 2});
  CHECK(listed(5, 5) == Numbers{5});
  CHECK(listed(5, 4).empty());
  CHECK(listed(kMost, kLeast).empty());
}

TEST_CASE("a range ends at the largest integer and begins at the least one") {
  CHECK(listed(kMost - 1, kMost) == Numbers{kMost - 1, kMost});
  CHECK(listed(kMost, kMost) == Numbers{kMost});
  CHECK(listed(kLeast, kLeast + 1) == Numbers{kLeast, kLeast + 1});
}

}  // namespace
}  // namespace parallax::test
