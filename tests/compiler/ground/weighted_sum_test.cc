// Counters against the sum worked out for every assignment.

#include "compiler/ground/weighted_sum.h"

#include <limits>

#include "tests/compiler/front_end.h"
#include "tests/support/random_model.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

using compiler::CompareOp;
using compiler::FormulaId;
using compiler::Truth;
using compiler::WeightedFormula;

constexpr std::size_t kAtoms = 7;

/// A model with as many fluents, at timepoints 0 to 3.
struct Atoms {
  TextModel model{
      "range time 0 3\nsort n: integer\nrange n 1 7\nfluent F(n)\nevent E()\n"
      "[n,time] Initiates(E(),F(n),time).\n"};
  compiler::GroundModel& ground = *model.ground;

  FormulaId atom(std::size_t i, compiler::Timepoint t = 0) {
    return ground.holds(static_cast<std::uint32_t>(i), t);
  }
  FormulaId compared(const std::vector<WeightedFormula>& terms, CompareOp op, std::int64_t number) {
    const auto sum = weighted_sum(ground, terms, number);
    REQUIRE(sum.has_value());
    return compare_sum(ground, *sum, op, [](std::size_t) { return true; });
  }
  /// An assignment: fluent i is true at timepoint t if bit i of `bits` is set.
  bool value(FormulaId formula, std::size_t bits) const {
    return evaluate(ground.formulas(), formula, [&](std::int32_t variable) {
             const auto set = ((bits >> ground.atom(variable).index) & 1U) != 0;
             return set ? Truth::kTrue : Truth::kFalse;
           }) == Truth::kTrue;
  }
};

TEST_CASE("a compared sum is true exactly where the numbers say so, for 1,500 random sums") {
  Atoms atoms;
  FuzzRandom random(3);
  auto& formulas = atoms.ground.formulas();
  const std::vector<std::int64_t> weights = {1, 1, 1, 2, 3, 5, 0, -1, -2, -4};
  for (int round = 0; round < 1500; ++round) {
    std::vector<WeightedFormula> terms;
    const bool counts = random.chance(40);
    for (std::size_t i = 0; i < random.below(9); ++i) {
      // The same formula, and its negation, may come several times.
      auto formula = atoms.atom(random.below(kAtoms));
      if (random.chance(15)) formula = formulas.conjunction(formula, ~atoms.atom(0));
      if (random.chance(10)) formula = formulas.constant(random.chance(50));
      if (random.chance(25)) formula = ~formula;
      terms.push_back({formula, counts ? 1 : random.pick(weights)});
    }
    const auto op = static_cast<CompareOp>(random.below(6));
    const auto number = static_cast<std::int64_t>(random.below(14)) - 5;
    const auto made = atoms.compared(terms, op, number);
    for (std::size_t bits = 0; bits < (1U << kAtoms); ++bits) {
      std::int64_t sum = 0;
      for (const auto& [formula, weight] : terms) sum += atoms.value(formula, bits) ? weight : 0;
      REQUIRE(atoms.value(made, bits) == compiler::compares(sum, op, number));
    }
  }
}

TEST_CASE("numbers at the ends of 64 bits are compared rightly, or refused") {
  constexpr auto kMost = std::numeric_limits<std::int64_t>::max();
  constexpr auto kLeast = std::numeric_limits<std::int64_t>::min();
  Atoms atoms;
  const auto a = atoms.atom(0), b = atoms.atom(1);
  const auto truth = atoms.ground.formulas().truth();
  CHECK(atoms.compared({{a, 1}}, CompareOp::kGreater, kMost) == ~truth);
  CHECK(atoms.compared({{a, 1}}, CompareOp::kLessEqual, kMost) == truth);
  CHECK(atoms.compared({{a, 1}}, CompareOp::kGreaterEqual, kLeast) == truth);
  CHECK(atoms.compared({{a, kMost}}, CompareOp::kEqual, kMost) == a);
  CHECK(atoms.compared({{a, -kMost}}, CompareOp::kLess, 0) == a);
  CHECK_FALSE(weighted_sum(atoms.ground, {{a, kMost}, {b, 1}}, 0));
  CHECK_FALSE(weighted_sum(atoms.ground, {{a, kLeast}}, 0));
  CHECK_FALSE(weighted_sum(atoms.ground, {{truth, -1}}, kMost));
}

TEST_CASE("a counter has a register for each term and bound, also after its atoms have moved") {
  TextModel model(
      "range time 0 1\nsort n: integer\nrange n 1 400\nfluent F(n)\nevent E()\n"
      "[n,time] Initiates(E(),F(n),time).\n");
  auto& formulas = model.ground->formulas();
  std::vector<WeightedFormula> terms;
  for (std::uint32_t i = 0; i < 400; ++i) terms.push_back({model.ground->holds(i, 0), 1});
  const auto sum = weighted_sum(*model.ground, terms, 10);
  const auto before = formulas.node_count();
  const auto made =
      compare_sum(*model.ground, *sum, CompareOp::kGreaterEqual, [](std::size_t) { return true; });
  // A register is an atom's part and the choice between two: two nodes for each term and bound.
  CHECK(formulas.node_count() - before < 2 * 400 * 10);
  (void)model.ground->shifted(made, 1);
  CHECK(formulas.node_count() - before < 2 * 2 * 400 * 10 + 400);
  std::size_t edges = 0;
  for (auto node = before; node < formulas.node_count(); ++node) {
    const auto id = formulas.at(static_cast<std::uint32_t>(node));
    if (formulas.kind(id) == compiler::FormulaNodeKind::kAnd) edges += formulas.children(id).size();
  }
  CHECK(edges < 3 * (formulas.node_count() - before));
}

TEST_CASE("a bound from above holds of the terms that exist so far") {
  Atoms atoms;
  auto& formulas = atoms.ground.formulas();
  // The later timepoint first: the counter puts them in order.
  const std::vector<WeightedFormula> terms = {
      {atoms.atom(0, 3), 1}, {atoms.atom(1, 2), 1}, {atoms.atom(2, 1), 1}, {atoms.atom(3, 0), 1}};
  std::vector<FormulaId> todo = {atoms.compared(terms, CompareOp::kLessEqual, 1)};
  std::vector<FormulaId> conjuncts;
  while (!todo.empty()) {
    const auto id = todo.back();
    todo.pop_back();
    if (id.negated() || formulas.kind(id) != compiler::FormulaNodeKind::kAnd) {
      conjuncts.push_back(id);
      continue;
    }
    const auto children = formulas.children(id);
    todo.insert(todo.end(), children.begin(), children.end());
  }
  // Those of the conjuncts that end at timepoint t admit one of the first t + 1 terms.
  for (compiler::Timepoint t = 0; t <= 3; ++t) {
    for (std::size_t bits = 0; bits < 16; ++bits) {
      bool holds = true;
      for (const auto conjunct : conjuncts) {
        compiler::Timepoint needed = 0;
        for (const auto variable : atoms_of(formulas, std::array{conjunct})) {
          needed = std::max(needed, atoms.ground.atom(variable).needed_horizon());
        }
        holds = holds && (needed > t || atoms.value(conjunct, bits));
      }
      int count = 0;
      for (compiler::Timepoint s = 0; s <= t; ++s) count += (bits >> (3 - s)) & 1U ? 1 : 0;
      CHECK(holds == (count <= 1));
    }
  }
}

TEST_CASE("a counter that is too large stops where the budget ends") {
  Atoms atoms;
  std::vector<WeightedFormula> terms;
  for (std::size_t i = 0; i < kAtoms; ++i) terms.push_back({atoms.atom(i), 1 << i});
  const auto sum = weighted_sum(atoms.ground, terms, 60);
  std::size_t spent = 0;
  (void)compare_sum(atoms.ground, *sum, CompareOp::kGreaterEqual, [&](std::size_t nodes) {
    spent += nodes;
    return spent < 5;
  });
  CHECK(spent < 20);
}

}  // namespace
}  // namespace parallax::test
