// Facts about unobserved fluents that follow from the outcomes of performs.

#include "tools/learn/outcome_facts.h"

#include <doctest/doctest.h>

#include <map>
#include <set>
#include <string>

#include "compiler/artifact/symbol_table.h"
#include "tests/support/planned_model.h"

namespace parallax::tools {
namespace {

const std::string kKitchen =
    "sort item\nsort kind\nitem mug1, mug2, fork1\nkind mug, fork\n"
    "predicate Kind(item,kind)\n"
    "fluent Visible(item)\nnoninertial Visible\nfluent Grasped(item)\n"
    "event Detect(kind)\nevent Grasp(item)\n"
    "[item] Kind(item,mug) <-> item=mug1 | item=mug2.\n"
    "[item] Kind(item,fork) <-> item=fork1.\n"
    "[item,time] Initiates(Grasp(item),Grasped(item),time).\n";
const std::string kBinding =
    "motion detecting (:object type ?y) -> Detect(?y)\n"
    "    ok: {item} Kind(item,?y) & Visible(item) @t returns item; else "
    "perception-object-not-found\n"
    "action grasping (:object ?o) -> Grasp(?o) ok: Grasped(?o) @t+1 else "
    "manipulation-pose-unreachable\n";
const std::string kPlan =
    "(def-cram-function grasp-a-mug ()\n"
    "  (let ((?mug (perform (a motion (type detecting) (object (an object (type mug)))))))\n"
    "    (perform (an action (type grasping) (object ?mug)))))\n"
    "(grasp-a-mug)\n";

/// One execution of the plan: detecting, then grasping.
class MugRun {
 public:
  MugRun() : planned_(kKitchen, kPlan, kBinding, "{item} HoldsAt(Grasped(item),time)", 2) {
    REQUIRE(planned_.compiles());
    path_.executed = true;
    path_.states.resize(1);
  }

  void step(const std::string& event, bool succeeded, const std::string& object) {
    const compiler::SymbolTable names(planned_.compiled());
    ObservedStep step;
    REQUIRE(names.event(event).has_value());
    step.event = *names.event(event);
    step.name = event;
    step.perform = compiler::PlanStepId(static_cast<std::uint32_t>(path_.steps.size()));
    step.succeeded = succeeded;
    step.object = object;
    path_.steps.push_back(step);
    path_.states.emplace_back();
  }

  /// "0 Visible(mug1)" true, by timepoint and name.
  std::map<std::string, bool> facts() {
    compiler::PlanQuestions questions(planned_.graph(), planned_.formulas(), planned_.typed());
    for (std::size_t i = 0; i < questions.predicates().size(); ++i) {
      const auto& name = questions.predicates()[i];
      questions.settle(i, name.substr(5, 3) == name.substr(name.find(',') + 1, 3));
    }
    add_outcome_facts(planned_.graph(), questions, planned_.compiled(), path_, symbols_);
    std::map<std::string, bool> out;
    for (std::size_t t = 0; t < path_.states.size(); ++t) {
      for (const auto& [fluent, holds] : path_.states[t]) {
        const auto& name = planned_.compiled().fluents[fluent.index()].name;
        out.emplace(std::to_string(t) + " " + name, holds);
      }
    }
    return out;
  }
  const std::set<std::string>& symbols() const { return symbols_; }

 private:
  test::PlannedModel planned_;
  ObservedPath path_;
  std::set<std::string> symbols_;
};

using Facts = std::map<std::string, bool>;

TEST_CASE("what was found was visible; of the others nothing is known") {
  MugRun run;
  run.step("Detect(mug)", true, "mug2");
  CHECK(run.facts() == Facts{{"0 Visible(mug2)", true}});
  CHECK(run.symbols() == std::set<std::string>{"Visible"});
}

TEST_CASE("where nothing was found, nothing of that kind was visible") {
  MugRun run;
  run.step("Detect(mug)", false, "");
  CHECK(run.facts() == Facts{{"0 Visible(mug1)", false}, {"0 Visible(mug2)", false}});
}

TEST_CASE("a later formula is about what was found, and about the state behind the step") {
  MugRun run;
  run.step("Detect(mug)", true, "mug1");
  run.step("Grasp(mug1)", true, "");
  CHECK(run.facts() == Facts{{"0 Visible(mug1)", true}, {"2 Grasped(mug1)", true}});
  CHECK(run.symbols() == std::set<std::string>{"Grasped", "Visible"});
}

}  // namespace
}  // namespace parallax::tools
