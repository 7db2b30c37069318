#include <doctest/doctest.h>

#include <string>

#include "tests/compiler/plan/plan_fixture.h"

namespace parallax::compiler {
namespace {

const std::string kGoals = std::string(kBinding) +
                           "goal (drawer-open ?d) -> Open(?d)\n"
                           "goal (object-in-hand ?o) -> exists arm. Holding(arm,?o)\n"
                           "goal (signalled) -> Signalled()\n";

std::string open_with(const std::string& goal) {
  return "(perform (an action (type opening) (object (an object (name d1))) (goal " + goal + ")))";
}

TEST_CASE("goals: an action whose goal holds is not carried out, and its value is nil") {
  const auto plan =
      unroll(prelude() + "(unless " + open_with("(drawer-open d1)") + " (sig))(go1)", {}, kGoals);
  CHECK(plan.codes().empty());
  REQUIRE(plan.graph.has_value());
  const auto& graph = *plan.graph;
  REQUIRE(std::holds_alternative<BranchId>(graph.entry));
  CHECK(graph.branches[std::get<BranchId>(graph.entry)].guard.text == "Open(d1)");
  CHECK(plan.events("+++") == Strings{"Signal()", "Go(r1)", "DONE"});
  CHECK(plan.events("-++") == Strings{"OpenDrawer(d1)", "Go(r1)", "DONE"});
}

TEST_CASE(
    "goals: those of variables, without arguments, and of actions that a function carries out") {
  const auto variable = unroll(
      prelude() + "(let ((?goal '(drawer-open d1))) " + open_with("?goal") + ")", {}, kGoals);
  REQUIRE(variable.graph.has_value());
  CHECK(std::holds_alternative<BranchId>(variable.graph->entry));
  const auto bare = unroll(prelude() + open_with("(signalled)"), {}, kGoals);
  REQUIRE(bare.graph.has_value());
  CHECK(bare.graph->branches[std::get<BranchId>(bare.graph->entry)].guard.text == "Signalled()");
  const auto function =
      unroll(prelude() +
                 "(defun fetch (o) (pick))"
                 "(perform (an action (type fetching) (object (an object (name box))) (goal "
                 "(object-in-hand box))))",
             {}, kGoals + "action fetching (:object name ?o) -> plan fetch(?o)\n");
  CHECK(function.codes().empty());
  REQUIRE(function.graph.has_value());
  CHECK(function.events("+") == Strings{"DONE"});
  CHECK(function.events("-+") == Strings{"PickUp(left,box)", "DONE"});
}

TEST_CASE("goals: one that is not bound is told once, and the action is carried out") {
  const auto plan =
      unroll(prelude() + "(dotimes (i 2) " + open_with("(drawer-clean d1)") + ")", {}, kGoals);
  CHECK(plan.codes() == Strings{"W-GOAL"});
  CHECK(plan.events("++") == Strings{"OpenDrawer(d1)", "OpenDrawer(d1)", "DONE"});
  // Another number of arguments is another goal.
  CHECK(unroll(prelude() + open_with("(drawer-open d1 d2)"), {}, kGoals).codes() ==
        Strings{"W-GOAL"});
  CHECK(unroll(prelude() + open_with("nil"), {}, kGoals).codes().empty());
}

TEST_CASE("goals: a goal is no target") {
  const std::string plan =
      prelude() + "(perform (an action (type navigating) (goal (robot-at kitchen))))";
  CHECK(unroll(plan, {}, kGoals).has("CPL030"));
}

TEST_CASE("goals: entries that are none, or stand there twice") {
  for (const std::string entry : {"goal object-in-hand -> Signalled()", "goal (a ?o)",
                                  "goal (a ?o) ok: Signalled()", "goal (a ?o) ->"}) {
    CAPTURE(entry);
    CHECK(unroll(prelude() + "(go1)", {}, std::string(kBinding) + entry + "\n").has("E4001"));
  }
  CHECK(unroll(prelude() + "(go1)", {}, kGoals + "goal (signalled) -> Signalled()\n").has("E4002"));
  CHECK(unroll(prelude() + "(go1)", {}, kGoals + "goal (a ?o) -> Open(?d)\n").has("E4003"));
}

}  // namespace
}  // namespace parallax::compiler
