#include "compiler/formula/formula.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <vector>

namespace parallax::compiler {
namespace {

/// Truth value of a formula when bit v - 1 of `valuation` is the value of variable v.
bool evaluate(const FormulaStore& store, FormulaId id, std::uint32_t valuation) {
  bool value = true;
  switch (store.kind(id)) {
    case FormulaNodeKind::kTrue:
      break;
    case FormulaNodeKind::kAtom:
      value = ((valuation >> static_cast<unsigned>(store.variable(id) - 1)) & 1U) != 0;
      break;
    case FormulaNodeKind::kAnd:
      for (const auto child : store.children(id)) {
        value = value && evaluate(store, child, valuation);
      }
      break;
  }
  return value != id.negated();
}

TEST_CASE("constants, duplicates and complements are resolved at construction") {
  FormulaStore store;
  const auto a = store.atom(1);
  const auto b = store.atom(2);
  CHECK(store.conjunction(a, ~a) == store.falsity());
  CHECK(store.disjunction(a, ~a) == store.truth());
  CHECK(store.conjunction(a, a) == a);
  CHECK(store.conjunction(a, store.truth()) == a);
  CHECK(store.conjunction(a, store.falsity()) == store.falsity());
  CHECK(store.conjunction(std::vector<FormulaId>{}) == store.truth());
  CHECK(store.disjunction(std::vector<FormulaId>{}) == store.falsity());
  CHECK(store.equivalence(a, a) == store.truth());
  CHECK(store.equivalence(a, ~a) == store.falsity());
  CHECK(store.conjunction(a, b) == store.conjunction(b, a));
}

TEST_CASE("equal formulas have equal ids, also nested and after the table has grown") {
  FormulaStore store;
  const auto left =
      store.conjunction(store.conjunction(store.atom(1), store.atom(2)), store.atom(3));
  const auto right =
      store.conjunction(store.atom(1), store.conjunction(store.atom(2), store.atom(3)));
  CHECK(left == right);
  std::vector<FormulaId> made;
  for (std::int32_t i = 1; i < 4000; ++i) {
    made.push_back(store.conjunction(store.atom(i), ~store.atom(i + 1)));
  }
  for (std::int32_t i = 1; i < 4000; ++i) {
    CHECK(made[static_cast<std::size_t>(i) - 1] ==
          store.conjunction(~store.atom(i + 1), store.atom(i)));
  }
}

TEST_CASE("connectives mean what they say on every valuation of random formulas") {
  constexpr std::int32_t kVariables = 4;
  FormulaStore store;
  std::uint64_t state = 12345;
  const auto random = [&](std::uint64_t below) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return (state >> 33U) % below;
  };
  std::vector<FormulaId> pool;
  for (std::int32_t v = 1; v <= kVariables; ++v) pool.push_back(store.atom(v));
  for (int round = 0; round < 300; ++round) {
    const auto pick = [&] {
      const auto id = pool[random(pool.size())];
      return random(2) == 0 ? id : ~id;
    };
    const auto a = pick();
    const auto b = pick();
    const auto c = pick();
    const auto both = store.conjunction({a, b, c});
    const auto either = store.disjunction({a, b, c});
    const auto same = store.equivalence(a, b);
    const auto implied = store.implication(a, b);
    for (std::uint32_t v = 0; v < (1U << kVariables); ++v) {
      const bool x = evaluate(store, a, v);
      const bool y = evaluate(store, b, v);
      const bool z = evaluate(store, c, v);
      REQUIRE(evaluate(store, both, v) == (x && y && z));
      REQUIRE(evaluate(store, either, v) == (x || y || z));
      REQUIRE(evaluate(store, same, v) == (x == y));
      REQUIRE(evaluate(store, implied, v) == (!x || y));
    }
    pool.push_back(both);
    pool.push_back(same);
  }
}

}  // namespace
}  // namespace parallax::compiler
