#include "compiler/cnf/clause_builder.h"

#include "compiler/ground/grounder.h"
#include "tests/compiler/front_end.h"

namespace parallax::test {
namespace {

using compiler::Constraint;

/// Three fluents over three timepoints, and clauses of constraints that the test adds.
struct Clauses {
  CheckedText checked{"range time 0 2\nfluent A()\nfluent B()\nfluent C()\nevent E()\n"};
  std::optional<compiler::GroundModel> model;
  std::uint32_t origin = 0;
  std::vector<Constraint> constraints = {};

  Clauses() {
    REQUIRE_MESSAGE(checked.model, checked.text());
    auto ground = compiler::ground_model(*checked.model, {}, checked.sink);
    REQUIRE(ground);
    model.emplace(*std::move(ground));
    origin = model->add_origin({}, compiler::OriginKind::kAxiom);
  }
  compiler::FormulaStore& formulas() { return model->formulas(); }
  compiler::FormulaId holds(std::uint32_t fluent, std::int32_t t) {
    return model->holds(fluent, t);
  }
  void add(compiler::FormulaId formula, std::int32_t width = Constraint::kOnce) {
    constraints.push_back({formula, origin, width});
  }
  std::string text() const {
    compiler::ClauseBuilder builder(*model);
    for (const auto& constraint : constraints) builder.add(constraint);
    return compiler::clause_lines(*model, builder, nullptr);
  }
};

TEST_CASE("a conjunction is split, a small disjunction is a clause") {
  Clauses clauses;
  auto& formulas = clauses.formulas();
  const auto a = clauses.holds(0, 0), b = clauses.holds(1, 0), c = clauses.holds(2, 0);
  clauses.add(formulas.conjunction(a, formulas.disjunction(~b, c)));
  CHECK(clauses.text() ==
        "; clauses\naxiom: HoldsAt(A(),0)\naxiom: !HoldsAt(B(),0) HoldsAt(C(),0)\n");
}

TEST_CASE("a part of a disjunction is defined in the polarity in which it stands there") {
  Clauses clauses;
  auto& formulas = clauses.formulas();
  const auto a = clauses.holds(0, 0), b = clauses.holds(1, 0), c = clauses.holds(2, 0);
  clauses.add(formulas.disjunction(a, formulas.conjunction(b, c)));
  CHECK(clauses.text() ==
        "; clauses\naxiom: HoldsAt(A(),0) #1\naxiom: !#1 HoldsAt(B(),0) (definition)\n"
        "axiom: !#1 HoldsAt(C(),0) (definition)\n");
}

TEST_CASE("a part that two constraints share has one auxiliary and each definition once") {
  Clauses clauses;
  auto& formulas = clauses.formulas();
  const auto a = clauses.holds(0, 0), b = clauses.holds(1, 0), c = clauses.holds(2, 0);
  const auto part = formulas.conjunction(b, c);
  clauses.add(formulas.disjunction(a, part));
  clauses.add(formulas.disjunction(~a, part));
  const auto text = clauses.text();
  CHECK(text.find("#2") == std::string::npos);
  CHECK(text.find("!#1 HoldsAt(B(),0)") == text.rfind("!#1 HoldsAt(B(),0)"));
  // In the other polarity: another clause of the same auxiliary.
  clauses.add(formulas.disjunction(a, formulas.conjunction(clauses.holds(0, 1), ~part)));
  CHECK(clauses.text().find("#1 !HoldsAt(B(),0) !HoldsAt(C(),0) (definition)") !=
        std::string::npos);
}

TEST_CASE("what holds at every timepoint is kept apart by its width") {
  Clauses clauses;
  auto& formulas = clauses.formulas();
  clauses.add(clauses.holds(0, 0));
  clauses.add(clauses.holds(1, 0), 0);
  clauses.add(formulas.implication(clauses.holds(0, 0), clauses.holds(0, 1)), 1);
  CHECK(clauses.text() ==
        "; clauses\naxiom: HoldsAt(A(),0)\n; clauses at every timepoint, width 0\n"
        "axiom: HoldsAt(B(),0)\n; clauses at every timepoint, width 1\n"
        "axiom: !HoldsAt(A(),0) HoldsAt(A(),1)\n");
}

TEST_CASE("truth makes no clause, falsity the empty one") {
  Clauses clauses;
  clauses.add(clauses.formulas().truth());
  CHECK(clauses.text() == "; clauses\n");
  clauses.add(clauses.formulas().falsity());
  CHECK(clauses.text() == "; clauses\naxiom:\n");
}

}  // namespace
}  // namespace parallax::test
