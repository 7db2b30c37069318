#include <doctest/doctest.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "tests/support/deep.h"
#include "tests/support/interpreter/interpreter.h"
#include "tests/support/interpreter/random_case.h"
#include "tests/support/planned_model.h"

namespace parallax::test {
namespace {

using runtime::Exploration;
using Strings = std::vector<std::string>;

std::string joined(const Strings& keys) {
  std::string out;
  for (const auto& key : keys) out += "  " + key + '\n';
  return out;
}

Executions executed_by_interpreter(const PlanCase& plan_case) {
  RuleWorld world(plan_case.model);
  constexpr std::size_t kMostRuns = 20'000;
  return execute_all(plan_case.plan_text(), world, plan_case.horizon, plan_case.by_turns,
                     kMostRuns);
}

/// Describes where the interpreter's executions differ from the solver's traces; empty if they
/// agree.
std::string disagreement(const PlanCase& plan_case, const Executions& executed) {
  const PlannedModel planned(plan_case.model.model_text(), plan_case.plan_text(),
                             plan_case.model.binding_text(), plan_case.model.constraint_text(),
                             plan_case.horizon, plan_case.by_turns);
  if (!planned.compiles()) return "not compiled: " + planned.codes();
  auto traces = planned.keys();
  const bool complete = traces.exploration == Exploration::kAllTracesExplored;
  std::sort(traces.keys.begin(), traces.keys.end());
  const Strings wanted(executed.keys.begin(), executed.keys.end());
  if (traces.keys != wanted) {
    return "executed\n" + joined(wanted) + "traces\n" + joined(traces.keys);
  }
  if (complete == executed.beyond_horizon) {
    return std::string("explored: ") + std::string(runtime::to_string(traces.exploration));
  }
  return {};
}

/// A case on which they disagree, made small; the text to paste into a test of its own.
std::string report(const PlanCase& found) {
  const auto small = shrunk(found, [](const PlanCase& candidate) {
    try {
      const auto text = disagreement(candidate, executed_by_interpreter(candidate));
      return !text.empty() && !text.starts_with("not compiled");
    } catch (const std::exception&) {
      return false;
    }
  });
  return small.model.model_text() + "\n" + small.model.binding_text() + "\n" + small.plan_text() +
         "\n" + small.model.constraint_text() + " within " + std::to_string(small.horizon) + "\n" +
         disagreement(small, executed_by_interpreter(small));
}

TEST_CASE("random plans in random models: what is executed is what is enumerated") {
  const std::uint64_t cases = is_deep() ? 5000 : 1000;
  std::size_t traces = 0;
  std::size_t picks = 0;
  int bounded = 0;
  int too_large = 0;
  for (std::uint64_t seed = 1; seed <= cases + static_cast<std::uint64_t>(too_large); ++seed) {
    const auto plan_case = random_plan_case(seed);
    std::string text;
    Executions executed;
    try {
      executed = executed_by_interpreter(plan_case);
      text = disagreement(plan_case, executed);
    } catch (const std::length_error&) {
      ++too_large;  // branches that ask and perform have very many orders
      continue;
    } catch (const std::exception& error) {
      text = std::string("thrown: ") + error.what();
    }
    // A few plans have more states than the unroller's limits admit.
    if (text.find("CPL051") != std::string::npos) {
      ++too_large;
      continue;
    }
    if (!text.empty()) {
      CAPTURE(seed);
      FAIL(text << "\n"
                << (text.starts_with("executed") || text.starts_with("explored")
                        ? report(plan_case)
                        : plan_case.plan_text()));
    }
    traces += executed.keys.size();
    picks += executed.runs - RuleWorld(plan_case.model).initial_states();
    if (executed.beyond_horizon) ++bounded;
  }
  // The generator is of use only if much happens.
  CHECK(too_large < 10 + static_cast<int>(cases) / 100);
  CHECK(traces > cases / 2);
  CHECK(picks > cases / 4);
  CHECK(bounded > static_cast<int>(cases) / 10);
  CHECK(bounded < 9 * static_cast<int>(cases) / 10);
}

TEST_CASE("a failing case is shrunk to what makes it fail") {
  const auto fails = [](const PlanCase& candidate) {
    return candidate.plan_text().find("(type waiting)") != std::string::npos &&
           !candidate.model.rules.empty();
  };
  std::uint64_t seed = 1;
  while (!fails(random_plan_case(seed))) ++seed;
  const auto large = random_plan_case(seed);
  const auto small = shrunk(large, fails);
  CHECK(small.plan_text().find("(type waiting)") != std::string::npos);
  CHECK(small.plan_text().size() < 60);
  CHECK(small.model.rules.size() == 1);
}

TEST_CASE("the interpreter tells plans apart that differ in one form") {
  // Retrying, falling through and returning from the same failure.
  RuleModel model;
  model.things = {{"t1", "k1"}};
  model.thing_fluents = {"Lit"};
  model.plain_fluents = {"Open"};
  model.thing_events = {"Poke"};
  model.plain_events = {"Wait"};
  model.rules = {{"Poke(t1)", {{"Open()", true}}, {"Lit(t1)", true}},
                 {"Wait()", {}, {"Open()", true}}};
  model.start = {{"Lit(t1)", false}, {"Open()", false}};
  model.bindings = {{"poking", "Poke(?o)", {{"Lit(?o)", true}}, 1, false, "low-level-failure"},
                    {"waiting", "Wait()", {}, 1, false, "plan-failure"}};
  model.goal = {{"Lit(t1)", true}};
  const auto executions = [&](const std::string& handler) {
    RuleWorld world(model);
    return execute_all(
        "(defun f () (with-retry-counters ((n 1)) (with-failure-handling "
        "((low-level-failure (e) " +
            handler +
            ")) (perform (an action (type poking) (object (an object (name "
            "t1))))))))",
        world, 5);
  };
  const auto retried = executions("(do-retry n (perform (an action (type waiting))) (retry))");
  CHECK(retried.keys == std::set<std::string>{"Poke(t1);Wait();Poke(t1);"});
  CHECK(executions("(do-retry n (retry))").keys.empty());
  CHECK(executions("(do-retry n (retry))").failures == std::set<std::string>{"low-level-failure"});
  CHECK(executions("(return)").failures.empty());
  CHECK(executions("(fail 'object-unfetchable)").failures ==
        std::set<std::string>{"object-unfetchable"});
  CHECK(executions("(retry)").beyond_horizon);
}

}  // namespace
}  // namespace parallax::test
