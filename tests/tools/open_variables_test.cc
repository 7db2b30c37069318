// The components of clauses that are kept from one question to the next.

#include "runtime/enumerate/open_variables.h"

#include <doctest/doctest.h>

#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

/// The solvers that are made for the same question twice and another one in between.
int solvers_made(runtime::OpenVariables::Bounds bounds) {
  const TextModel text(
      "range time 0 1\nfluent F()\npredicate P()\npredicate Q()\npredicate R()\n"
      "HoldsAt(F(),0) -> P() | Q().\n!HoldsAt(F(),0) -> Q() | R().\n");
  REQUIRE(text.ground != nullptr);
  std::vector<compiler::Literal> asked, told;
  text.compiled.for_each_atom([&](const compiler::AtomRef& atom) {
    if (atom.kind == compiler::AtomKind::kPredicate) asked.push_back(atom.literal());
    if (atom.kind == compiler::AtomKind::kHoldsAt && atom.time == 0) told = {atom.literal()};
  });
  REQUIRE(asked.size() == 3);
  REQUIRE(told.size() == 1);
  int made = 0;
  const auto make_solver = [&made] {
    ++made;
    return runtime::make_cadical_solver();
  };
  runtime::OpenVariables variables(text.compiled, asked, make_solver, bounds);
  const auto other = ~told.front();
  for (const auto literal : {told.front(), other, told.front()}) {
    const auto open = variables.find(std::span(&literal, 1));
    REQUIRE(open.has_value());
    CHECK(open->size() == 3);  // two of one clause, and one without any
  }
  return made;
}

TEST_CASE("components are kept up to a number of codes, each and together") {
  // Each component is one clause of two literals and its end.
  CHECK(solvers_made(runtime::OpenVariables::kBounds) == 2);
  CHECK(solvers_made({6, 3}) == 2);
  CHECK(solvers_made({5, 3}) == 3);
  CHECK(solvers_made({6, 2}) == 3);
}

}  // namespace
}  // namespace parallax::test
