// Queries on finished formulas: atoms, values, substitution, text.

#include <doctest/doctest.h>

#include <array>
#include <string>
#include <vector>

#include "compiler/formula/formula.h"
#include "tests/support/random.h"

namespace parallax::test {
namespace {

using compiler::FormulaId;
using compiler::FormulaStore;
using compiler::Truth;

std::string letter(std::int32_t variable) {
  return std::string(1, static_cast<char>('a' + variable - 1));
}

compiler::FormulaText letters(const FormulaStore& store) { return {store, letter}; }

TEST_CASE("atoms of formulas are their variables, ascending, each once") {
  FormulaStore store;
  const auto a = store.atom(1), b = store.atom(2), c = store.atom(3);
  const std::array formulas = {store.disjunction(c, store.conjunction(a, ~b)), ~c};
  CHECK(compiler::atoms_of(store, formulas) == std::vector<std::int32_t>{1, 2, 3});
  CHECK(compiler::atoms_of(store, {}).empty());
}

TEST_CASE("positive atoms stand under an even number of negations") {
  FormulaStore store;
  const auto a = store.atom(1), b = store.atom(2), c = store.atom(3);
  CHECK(compiler::positive_atoms(store, store.implication(a, b)) == std::vector<std::int32_t>{2});
  CHECK(compiler::positive_atoms(store, ~store.implication(a, ~b)) ==
        std::vector<std::int32_t>{1, 2});
  CHECK(compiler::positive_atoms(store, store.equivalence(a, c)) ==
        std::vector<std::int32_t>{1, 3});
}

TEST_CASE("what is unknown leaves a value open only where it matters") {
  FormulaStore store;
  const auto a = store.atom(1), b = store.atom(2);
  const auto with = [&](Truth value_of_a, FormulaId formula) {
    return compiler::evaluate(store, formula, [&](std::int32_t variable) {
      return variable == 1 ? value_of_a : Truth::kUnknown;
    });
  };
  CHECK(with(Truth::kFalse, store.conjunction(a, b)) == Truth::kFalse);
  CHECK(with(Truth::kTrue, store.conjunction(a, b)) == Truth::kUnknown);
  CHECK(with(Truth::kTrue, store.disjunction(a, b)) == Truth::kTrue);
  CHECK(with(Truth::kFalse, store.implication(a, b)) == Truth::kTrue);
  CHECK(with(Truth::kUnknown, store.truth()) == Truth::kTrue);
  CHECK(with(Truth::kUnknown, store.falsity()) == Truth::kFalse);
}

TEST_CASE("a formula with an atom replaced has the value that the atom's value gives it") {
  FormulaStore store;
  Random random(7);
  std::vector<FormulaId> pool;
  for (std::int32_t v = 1; v <= 4; ++v) pool.push_back(store.atom(v));
  for (int round = 0; round < 200; ++round) {
    const auto pick = [&] {
      const auto id = pool[random.below(pool.size())];
      return random.below(2) == 0 ? id : ~id;
    };
    const auto x = pick(), y = pick();
    pool.push_back(random.below(2) == 0 ? store.conjunction(x, y) : store.equivalence(x, y));
    const auto formula = pick();
    const auto variable = static_cast<std::int32_t>(1 + random.below(4));
    const bool value = random.below(2) == 0;
    const auto replaced = compiler::substitute(store, formula, variable, value);
    for (std::uint32_t bits = 0; bits < 16; ++bits) {
      const auto known = [&](std::int32_t v) {
        return ((bits >> static_cast<unsigned>(v - 1)) & 1U) != 0 ? Truth::kTrue : Truth::kFalse;
      };
      const auto fixed = [&](std::int32_t v) {
        if (v == variable) return value ? Truth::kTrue : Truth::kFalse;
        return known(v);
      };
      REQUIRE(compiler::evaluate(store, replaced, known) ==
              compiler::evaluate(store, formula, fixed));
    }
  }
}

TEST_CASE("rewriting with one memo asks for each atom once") {
  FormulaStore store;
  const auto a = store.atom(1), b = store.atom(2), c = store.atom(3);
  compiler::RewriteMemo memo;
  int asked = 0;
  const auto next = [&](std::int32_t variable) { return ++asked, store.atom(variable + 1); };
  const auto both = store.conjunction(a, b);
  CHECK(compiler::rewrite_atoms(store, both, next, memo) == store.conjunction(b, c));
  CHECK(compiler::rewrite_atoms(store, ~both, next, memo) == ~store.conjunction(b, c));
  CHECK(asked == 2);
}

TEST_CASE("formulas are printed with or, and, and not") {
  FormulaStore store;
  const auto a = store.atom(1), b = store.atom(2), c = store.atom(3);
  CHECK(letters(store).text(~a) == "!a");
  CHECK(letters(store).text(store.truth()) == "true");
  CHECK(letters(store).text(store.falsity()) == "false");
  CHECK(letters(store).text(store.disjunction(~a, store.conjunction(b, ~c))) == "!a | (b & !c)");
}

TEST_CASE("a part that occurs twice is named, and defined once") {
  FormulaStore store;
  const auto a = store.atom(1), b = store.atom(2), c = store.atom(3);
  const auto d = store.atom(4), e = store.atom(5);
  const auto part = store.conjunction(a, b);
  const auto first = store.disjunction(part, c);
  const auto second = store.disjunction(d, store.conjunction(e, ~part));
  auto text = letters(store);
  text.count(first);
  text.count(second);
  CHECK(text.text(first) == "c | #1");
  CHECK(text.text(second) == "d | (e & !#1)");
  CHECK(text.definitions() == "#1 = a & b\n");
}

TEST_CASE("the text is linear where the tree is exponential, and needs no recursion") {
  FormulaStore store;
  constexpr std::int32_t kDepth = 20'000;
  auto formula = store.atom(1);
  for (std::int32_t v = 2; v <= kDepth; ++v) formula = store.equivalence(formula, store.atom(v));
  compiler::FormulaText text(store, [](std::int32_t v) { return std::to_string(v); });
  text.count(formula);
  const auto whole = text.text(formula).size();
  CHECK(whole + text.definitions().size() < 100UL * kDepth);
  auto deep = store.atom(1);
  for (std::int32_t v = 2; v <= kDepth; ++v) {
    deep = v % 2 == 0 ? store.disjunction(deep, store.atom(v))
                      : store.conjunction(deep, store.atom(v));
  }
  compiler::FormulaText once(store, [](std::int32_t) { return "x"; });
  once.count(deep);
  CHECK(once.text(deep).size() > kDepth);
  CHECK(once.definitions().empty());
}

}  // namespace
}  // namespace parallax::test
