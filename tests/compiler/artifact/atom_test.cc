// Atoms of the plan, kinds of origins and the names behind ids.

#include "compiler/artifact/atom.h"

#include <doctest/doctest.h>

#include "compiler/artifact/artifact_reader.h"
#include "compiler/artifact/symbol_table.h"

namespace parallax::compiler {
namespace {

TEST_CASE("atoms of the plan are read as what they say, and printed as they were written") {
  struct Known {
    AtomKind kind;
    const char* text;
    PlanAtom plan;
  };
  const std::vector<Known> known = {
      {AtomKind::kLocation, "L3", PlanStepId(3)},
      {AtomKind::kLocation, "BOUND(0)", PlanCutId(0)},
      {AtomKind::kLocation, "CHOICE(12)", PlanChoiceId(12)},
      {AtomKind::kLocation, "DONE", PlanEnd{"DONE"}},
      {AtomKind::kLocation, "FAILED(L3)", PlanEnd{"FAILED(L3)"}},
      {AtomKind::kSucceeded, "L0", PlanStepId(0)},
      {AtomKind::kResult, "L3", ReturnedObject{"L3"}},
      {AtomKind::kRegister, "?x=cup1", RegisterValue{"?x", "cup1"}},
      {AtomKind::kRegister, "?x=Pair(a,b=c)", RegisterValue{"?x", "Pair(a,b=c)"}},
      {AtomKind::kHit, "hit", std::monostate{}},
      {AtomKind::kRunning, "running", std::monostate{}},
  };
  for (const auto& one : known) {
    CAPTURE(one.text);
    CHECK(plan_atom(one.kind, one.text) == one.plan);
    CHECK(to_string(one.kind, one.plan) == one.text);
    CHECK(is_of_plan(one.kind));
  }
}

TEST_CASE("a text of no known form is an end of the plan and keeps its bytes") {
  for (const auto* text :
       {"L", "L03", "L-1", "L3x", "L99999999999", "BOUND(1", "CHOICE()", "hit"}) {
    CAPTURE(text);
    CHECK(plan_atom(AtomKind::kLocation, text) == PlanAtom(PlanEnd{text}));
    CHECK(to_string(AtomKind::kLocation, plan_atom(AtomKind::kLocation, text)) == text);
  }
  CHECK(plan_atom(AtomKind::kSucceeded, "BOUND(0)") == PlanAtom(PlanEnd{"BOUND(0)"}));
  CHECK(plan_atom(AtomKind::kRegister, "cup1") == PlanAtom(PlanEnd{"cup1"}));
}

TEST_CASE("atoms are printed by their name, those of the plan by what they say") {
  CHECK(printed({AtomKind::kHoldsAt, "On(cup)", 1, {}}) == "On(cup)");
  CHECK(printed({AtomKind::kLocation, "", 1, PlanStepId(2)}) == "L2");
}

TEST_CASE("atoms are found by what they say") {
  CompiledModel model;
  model.horizon = 1;
  model.fixed = {{AtomKind::kLocation, "", 1, PlanStepId(2)},
                 {AtomKind::kSucceeded, "", 1, PlanStepId(2)},
                 {AtomKind::kLocation, "", 1, PlanCutId(2)},
                 {AtomKind::kHit, "", 1, {}},
                 {AtomKind::kRunning, "", 0, {}},
                 {AtomKind::kPredicate, "P()", std::nullopt, {}}};
  const AtomIndex index(model);
  CHECK(index.at(PlanStepId(2), 1) == Literal::positive(1));
  CHECK(index.succeeded(PlanStepId(2), 1) == Literal::positive(2));
  CHECK(index.at(PlanCutId(2), 1) == Literal::positive(3));
  CHECK(index.hit(1) == Literal::positive(4));
  CHECK(index.running(0) == Literal::positive(5));
  CHECK(index.find(AtomKind::kPredicate, "P()", std::nullopt) == Literal::positive(6));
  CHECK_FALSE(index.at(PlanStepId(2), 0));
  CHECK_FALSE(index.hit(0));
  CHECK_FALSE(index.find(AtomKind::kHit, "hit", 1));
}

TEST_CASE("every kind of origin has a text of its own") {
  CHECK(to_string(OriginKind::kAxiom) == "axiom");
  CHECK(to_string(OriginKind::kUnmentioned) == "atom without a mention");
  for (auto kind = 0; kind <= static_cast<int>(OriginKind::kTrace); ++kind) {
    const auto text = to_string(static_cast<OriginKind>(kind));
    REQUIRE(!text.empty());
    CHECK(kOriginKindWords.find(text) == static_cast<OriginKind>(kind));
  }
  CHECK_FALSE(kOriginKindWords.find("axioms"));
}

TEST_CASE("names behind ids: those of a model first, each once") {
  CompiledModel model;
  model.fluents = {{"On(a)", 0}, {"On(b)", std::nullopt}};
  model.events = {{"Put(a)", std::nullopt}};
  SymbolTable table(model);
  CHECK(table.fluent("On(b)") == FluentId(1));
  CHECK(table.name(FluentId(0)) == "On(a)");
  CHECK(table.name(EventId(0)) == "Put(a)");
  CHECK_FALSE(table.fluent("Put(a)"));
  CHECK_FALSE(table.event("Take(a)"));
  CHECK(table.add_event("Take(a)") == EventId(1));
  CHECK(table.add_event("Take(a)") == EventId(1));
  CHECK(table.add_fluent("On(a)") == FluentId(0));
  CHECK(table.event_count() == 2);
  CHECK(table.fluent_count() == 2);
}

}  // namespace
}  // namespace parallax::compiler
