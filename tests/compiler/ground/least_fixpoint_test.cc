// The least solution of equations between formulas.

#include "compiler/ground/least_fixpoint.h"

#include <doctest/doctest.h>

#include "tests/support/random_model.h"

namespace parallax::test {
namespace {

using compiler::FixpointCycle;
using compiler::FixpointResult;
using compiler::FixpointSystem;
using compiler::FixpointTooLarge;
using compiler::FormulaId;
using compiler::FormulaStore;
using compiler::least_fixpoint;
using Solution = std::vector<FormulaId>;

// Variables from 1 on are atoms, from 101 on unknowns.
FixpointSystem equations(std::vector<FormulaId> definitions) {
  FixpointSystem system;
  for (std::size_t i = 0; i < definitions.size(); ++i) {
    system.unknown_of.emplace(static_cast<std::int32_t>(101 + i), i);
  }
  system.definitions = std::move(definitions);
  return system;
}

TEST_CASE("what depends on nothing is taken over, what depends on that is unfolded") {
  FormulaStore store;
  const auto a = store.atom(1), b = store.atom(2), x = store.atom(101), y = store.atom(102);
  const auto result =
      least_fixpoint(store, equations({a, store.conjunction(x, b), store.disjunction(~y, a)}), 100);
  CHECK(std::get<Solution>(result) ==
        Solution{a, store.conjunction(a, b), store.disjunction(~store.conjunction(a, b), a)});
}

TEST_CASE("unknowns that only need one another are false") {
  FormulaStore store;
  const auto a = store.atom(1), x = store.atom(101), y = store.atom(102);
  CHECK(std::get<Solution>(least_fixpoint(store, equations({y, x}), 100)) ==
        Solution{store.falsity(), store.falsity()});
  CHECK(std::get<Solution>(least_fixpoint(store, equations({store.disjunction(y, a), x}), 100)) ==
        Solution{a, a});
}

TEST_CASE("a cycle through a negation is given with its path, the negated need first") {
  FormulaStore store;
  const auto a = store.atom(1), x = store.atom(101), y = store.atom(102), z = store.atom(103);
  const auto result =
      least_fixpoint(store, equations({store.conjunction(z, a), ~x, store.disjunction(y, a)}), 100);
  REQUIRE(std::holds_alternative<FixpointCycle>(result));
  const auto& path = std::get<FixpointCycle>(result).path;
  REQUIRE(path.size() == 3);
  CHECK(path[0].unknown == 1);
  CHECK(path[0].negated);
  CHECK(path[1].unknown == 0);
  CHECK(path[2].unknown == 2);
  CHECK_FALSE(path[1].negated);
  const auto itself = least_fixpoint(store, equations({~x}), 100);
  REQUIRE(std::holds_alternative<FixpointCycle>(itself));
  CHECK(std::get<FixpointCycle>(itself).path.size() == 1);
}

TEST_CASE("the work is bounded") {
  FormulaStore store;
  std::vector<FormulaId> definitions;
  // A ring of 60 unknowns, each with an atom of its own.
  for (std::int32_t i = 0; i < 60; ++i) {
    const auto next = store.atom(101 + (i + 1) % 60);
    definitions.push_back(
        store.disjunction(store.atom(1 + i), store.conjunction(next, store.atom(61 + i % 30))));
  }
  const auto system = equations(definitions);
  CHECK(std::holds_alternative<FixpointTooLarge>(least_fixpoint(store, system, 20)));
  CHECK(std::holds_alternative<Solution>(least_fixpoint(store, system, 100'000)));
}

TEST_CASE("random positive systems: the solution is what iterating from false gives") {
  FuzzRandom random(7);
  for (int round = 0; round < 300; ++round) {
    FormulaStore store;
    const auto count = 1 + random.below(5);
    std::vector<FormulaId> definitions;
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<FormulaId> ways;
      for (std::size_t w = random.below(4); w > 0; --w) {
        std::vector<FormulaId> parts;
        for (std::size_t p = 1 + random.below(3); p > 0; --p) {
          const bool unknown = random.chance(60);
          const auto atom = store.atom(
              static_cast<std::int32_t>(unknown ? 101 + random.below(count) : 1 + random.below(3)));
          parts.push_back(!unknown && random.chance(40) ? ~atom : atom);
        }
        ways.push_back(store.conjunction(parts));
      }
      definitions.push_back(store.disjunction(ways));
    }
    const auto result = least_fixpoint(store, equations(definitions), 100'000);
    REQUIRE(std::holds_alternative<Solution>(result));
    for (std::size_t bits = 0; bits < 8; ++bits) {
      std::vector<bool> values(count, false);
      const auto value = [&](FormulaId formula) {
        return compiler::evaluate(store, formula, [&](std::int32_t variable) {
          const bool is = variable > 100 ? values[static_cast<std::size_t>(variable) - 101]
                                         : ((bits >> (variable - 1)) & 1U) != 0;
          return is ? compiler::Truth::kTrue : compiler::Truth::kFalse;
        });
      };
      for (std::size_t i = 0; i < count; ++i) {
        std::vector<bool> next(count);
        for (std::size_t k = 0; k < count; ++k) {
          next[k] = value(definitions[k]) == compiler::Truth::kTrue;
        }
        values = next;
      }
      for (std::size_t k = 0; k < count; ++k) {
        CHECK((value(std::get<Solution>(result)[k]) == compiler::Truth::kTrue) == values[k]);
      }
    }
  }
}

}  // namespace
}  // namespace parallax::test
