#include "runtime/compare/literal_lists.h"

#include <doctest/doctest.h>

#include <map>
#include <vector>

#include "tests/support/random.h"

namespace parallax::runtime {
namespace {

using compiler::Literal;

TEST_CASE("lists are found again by what is in them, as in a map") {
  test::Random random(7);
  LiteralLists lists;
  std::map<std::vector<std::int32_t>, std::int32_t> expected;
  std::size_t known = 0;
  for (std::int32_t i = 1; i <= 20000; ++i) {
    std::vector<Literal> list;
    std::vector<std::int32_t> key;
    // Short ones over few variables come again; the empty one is one, too.
    for (auto n = random.below(6); n > 0; --n) {
      const auto value = static_cast<std::int32_t>(random.below(9)) + 1;
      list.push_back(Literal::from_dimacs(random.below(2) == 0 ? value : -value));
      key.push_back(list.back().dimacs());
    }
    const auto before = expected.find(key);
    known += before == expected.end() ? 0 : 1;
    CHECK(lists.contains(list) == (before != expected.end()));
    const auto found = lists.find(list);
    REQUIRE(found.has_value() == (before != expected.end()));
    if (found) CHECK(found->dimacs() == before->second);
    lists.emplace(list, Literal::positive(i));
    expected.emplace(key, i);
    CHECK(lists.find(list)->dimacs() == expected.at(key));
  }
  CHECK(known > 1000);
  CHECK(expected.size() > 1000);
}

}  // namespace
}  // namespace parallax::runtime
