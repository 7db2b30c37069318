#include "compiler/reference/expanded_model.h"

#include <array>

#include "tests/compiler/front_end.h"

namespace parallax::test {
namespace {

using compiler::ExpandedModel;
using compiler::FormulaKind;
using compiler::FormulaTrees;
using compiler::ReferenceBudget;

TEST_CASE("constants are worked out of a tree, everything else stays as written") {
  FormulaTrees trees;
  const auto a = trees.atom(0), b = trees.atom(1);
  const auto truth = FormulaTrees::kTruth, falsity = FormulaTrees::kFalsity;
  CHECK(trees.connect(FormulaKind::kAnd, {a, truth}) == a);
  CHECK(trees.connect(FormulaKind::kAnd, {a, falsity}) == falsity);
  CHECK(trees.connect(FormulaKind::kOr, {falsity, b}) == b);
  CHECK(trees.connect(FormulaKind::kNot, {truth}) == falsity);
  CHECK(trees.connect(FormulaKind::kImplies, {truth, b}) == b);
  CHECK(trees.connect(FormulaKind::kIff, {truth, b}) == b);
  CHECK(trees.connect(FormulaKind::kAnd, {a, b}) != trees.connect(FormulaKind::kAnd, {a, b}));
}

TEST_CASE("a tree has the value that its connectives give it") {
  FormulaTrees trees;
  const auto a = trees.atom(0), b = trees.atom(1);
  const auto implies = trees.connect(FormulaKind::kImplies, {a, b});
  const auto iff = trees.connect(FormulaKind::kIff, {a, b});
  constexpr std::array<std::uint8_t, 2> kBits = {0, 1};
  for (const std::uint8_t x : kBits) {
    for (const std::uint8_t y : kBits) {
      CHECK(trees.value(implies, {x, y}) == (x == 0 || y == 1));
      CHECK(trees.value(iff, {x, y}) == (x == y));
    }
  }
}

TEST_CASE("a compared sum adds the weights of its true parts, and is forgotten with its node") {
  FormulaTrees trees;
  const auto a = trees.atom(0), b = trees.atom(1);
  const auto truth = FormulaTrees::kTruth;
  const auto size = trees.size();
  const FormulaTrees::Sum sum{compiler::CompareOp::kEqual, 3, {2, 5, 1}};
  (void)trees.compared({compiler::CompareOp::kLess, 0, {1}}, {a});
  trees.rewind(size);
  const auto made = trees.compared(sum, {a, b, truth});
  CHECK(trees.value(made, {1, 0}));
  CHECK_FALSE(trees.value(made, {1, 1}));
  CHECK_FALSE(trees.value(made, {0, 0}));
  CHECK(trees.atoms_of(made) == std::vector<std::uint32_t>{0, 1});
  CHECK(trees.compared({compiler::CompareOp::kGreater, 2, {3}}, {truth}) == truth);
  CHECK(trees.compared({compiler::CompareOp::kGreater, 0, {}}, {}) == FormulaTrees::kFalsity);
}

TEST_CASE("conjuncts and atoms of a tree, and what rewinding forgets") {
  FormulaTrees trees;
  const auto a = trees.atom(3), b = trees.atom(1);
  const auto both = trees.connect(FormulaKind::kAnd, {a, b});
  CHECK(trees.conjuncts(both) == std::vector<FormulaTrees::Node>{a, b});
  CHECK(trees.conjuncts(a) == std::vector<FormulaTrees::Node>{a});
  CHECK(trees.atoms_of(both) == std::vector<std::uint32_t>{1, 3});
  const auto size = trees.size();
  const auto more = trees.connect(FormulaKind::kOr, {both, trees.atom(5)});
  trees.rewind(size);
  CHECK(trees.size() == size);
  CHECK(trees.connect(FormulaKind::kOr, {both, trees.atom(6)}) == more);
  CHECK(trees.atoms_of(more) == std::vector<std::uint32_t>{1, 3, 6});
}

TEST_CASE("every instance is written out, and what lies beyond the horizon says nothing") {
  const CheckedText checked(
      "range time 0 2\nsort n: integer\nrange n 1 2\nfluent F(n)\nevent E()\n"
      "[n,time] HoldsAt(F(n),time) -> HoldsAt(F(n),time+1).\n[time] time>5 & "
      "HoldsAt(F(1),time+9).\n"
      "[n,time] Initiates(E(),F(n),time).\n");
  REQUIRE_MESSAGE(checked.model, checked.text());
  ReferenceBudget budget(100'000, nullptr);
  const ExpandedModel expanded(*checked.model, budget);
  REQUIRE(!budget.spent());
  CHECK(expanded.horizon() == 2);
  CHECK(expanded.fluents() == Strings{"F(1)", "F(2)"});
  CHECK(expanded.events() == Strings{"E()"});
  CHECK(expanded.conjuncts().size() == 2 * 2);  // two values, two steps
  CHECK(expanded.silent_axioms() == std::vector<std::size_t>{1});
  CHECK(expanded.rows(0, 1).size() == 1);
  const auto atom = expanded.happens(0, 1);
  CHECK(expanded.atom_text(atom) == "Happens(E(),1)");
  CHECK(expanded.timepoint(atom) == 1);
  CHECK(expanded.needed(atom) == 2);
  CHECK(expanded.atom_text(expanded.holds(1, 2)) == "HoldsAt(F(2),2)");
  CHECK(expanded.atom_text(expanded.released(0, 0)) == "ReleasedAt(F(1),0)");
}

TEST_CASE("what costs more than the budget is left unfinished, and says so") {
  const CheckedText checked(
      "range time 0 9\nsort n: integer\nrange n 1 50\nfluent F(n)\n"
      "[n1,n2,time] HoldsAt(F(n1),time) -> HoldsAt(F(n2),time).\n");
  REQUIRE_MESSAGE(checked.model, checked.text());
  ReferenceBudget budget(1000, nullptr);
  const ExpandedModel expanded(*checked.model, budget);
  CHECK(budget.spent());
}

}  // namespace
}  // namespace parallax::test
