#include "runtime/enumerate/plan_enumerator.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>

#include "compiler/pipeline/compile.h"
#include "compiler/plan/plan_graph.h"
#include "runtime/enumerate/dead_steps.h"
#include "tests/support/planned_model.h"

namespace parallax::test {
namespace {

using runtime::Exploration;

/// Two rooms, a lamp in each; switching works only where the robot is.
const std::string kRooms = kTwoRooms + R"(
fluent Lit(room)
event Switch(room)
[room,time] HoldsAt(At(room),time) & !HoldsAt(Lit(room),time) -> Initiates(Switch(room),Lit(room),time).
[room,time] HoldsAt(At(room),time) & HoldsAt(Lit(room),time) -> Terminates(Switch(room),Lit(room),time).
)";

const std::string kBinding = kGoing + R"(
action switching (:object ?o) -> Switch(?o)  ok: Lit(?o) @t+1 else manipulation-low-level-failure
)";

constexpr const char* kPlan = R"(
(def-cram-function light ()
  (let ((?b (make-pose-stamped "map" 0.0 (make-3d-vector 1.5 0 0) (make-identity-rotation))))
    (perform (an action (type switching) (object (an object (name a1)))))
    (perform (a motion (type going) (pose ?b)))
    (perform (an action (type switching) (object (an object (name b2)))))))
(light)
)";

TEST_CASE("a trace ends where the constraint holds for the first time, shortest first") {
  PlannedModel model(kRooms, kPlan, kBinding, "HoldsAt(At(b2),time)", 5);
  REQUIRE(model.codes() == "");
  // Free initial state: in b2 already, or in a1. Switch fails in b2 (not there) and if a1 is lit.
  const auto found = model.keys();
  CHECK(found.keys == std::vector<std::string>{"Switch(a1);", "Switch(a1);Go(b2);"});
  CHECK(found.exploration == Exploration::kAllTracesExplored);
}

TEST_CASE("failing performs end the plan, and what was done before can still hit") {
  PlannedModel model(kRooms + "HoldsAt(At(a1),0).\n", kPlan, kBinding,
                     "HoldsAt(Lit(b2),time) & {event} Happens(event,time-1)", 6);
  REQUIRE(model.codes() == "");
  // b2 lit from the start: hit after the first step. b2 dark: after all three.
  CHECK(model.keys().keys ==
        std::vector<std::string>{"Switch(a1);", "Switch(a1);Go(b2);Switch(b2);"});
}

TEST_CASE("a trace does not need a continuation: the next step may be impossible") {
  const std::string model_text =
      kRooms +
      "HoldsAt(At(a1),0).\n!HoldsAt(Lit(a1),0).\n!HoldsAt(Lit(b2),0).\n"
      "[time] Happens(Switch(b2),time) -> HoldsAt(At(a1),time).\n";  // never true in this plan
  for (const int horizon : {2, 3, 4, 6}) {
    CAPTURE(horizon);
    PlannedModel model(model_text, kPlan, kBinding, "HoldsAt(At(b2),time)", horizon);
    REQUIRE(model.codes() == "");
    CHECK(model.keys().keys == std::vector<std::string>{"Switch(a1);Go(b2);"});
  }
}

TEST_CASE("the traces within a horizon are the short ones of a longer horizon") {
  std::vector<std::string> before;
  for (int horizon = 1; horizon <= 6; ++horizon) {
    PlannedModel model(kRooms, kPlan, kBinding,
                       "HoldsAt(Lit(b2),time) & {event} Happens(event,time-1)", horizon);
    REQUIRE(model.codes() == "");
    const auto now = model.keys().keys;
    REQUIRE(now.size() >= before.size());
    CHECK(std::vector<std::string>(
              now.begin(), now.begin() + static_cast<std::ptrdiff_t>(before.size())) == before);
    before = now;
  }
  CHECK(before.size() >= 2);
}

TEST_CASE("a plan that outlasts the horizon is complete up to the bound only") {
  PlannedModel cut(kRooms + "HoldsAt(At(a1),0).\n!HoldsAt(Lit(b2),0).\n", kPlan, kBinding,
                   "HoldsAt(Lit(b2),time)", 2);
  REQUIRE(cut.codes() == "");
  const auto found = cut.keys();
  CHECK(found.keys.empty());
  CHECK(found.exploration == Exploration::kCompleteUpToBound);
}

constexpr const char* kShut = "HoldsAt(At(a1),0).\n!HoldsAt(Lit(a1),0).\n!HoldsAt(Lit(b2),0).\n";

TEST_CASE("what was not followed is named: the step at the horizon, the loop that was cut") {
  PlannedModel cut(kRooms + kShut, kPlan, kBinding, "HoldsAt(Lit(b2),time)", 2);
  REQUIRE(cut.codes() == "");
  const auto ends = cut.keys().open_ends;
  CHECK(ends.cuts.empty());
  CHECK(ends.step == 2);  // switching in b2

  // Driving to and fro for ever, with a variable that makes every round a new state.
  const std::string endless = R"(
(defun drive () (perform (a motion (type going) (pose (make-pose-stamped "map" 0.0
  (make-3d-vector 0.5 0 0) (make-identity-rotation))))))
(let ((?n 0)) (loop do (incf ?n) (drive)))
)";
  PlannedModel loop(kRooms + kShut, endless, kBinding, "HoldsAt(At(b2),time)", 20);
  REQUIRE(loop.codes() == "");
  const auto found = loop.keys();
  CHECK(found.exploration == Exploration::kCompleteUpToBound);
  REQUIRE(found.open_ends.cuts == std::vector<std::size_t>{0});
  CHECK(!found.open_ends.step);
  REQUIRE(loop.compiled().plan_cuts.size() == 1);
  CHECK(loop.compiled().plan_cuts[0].form == "loop");
  CHECK(loop.compiled().plan_cuts[0].place.begin.line == 4);

  PlannedModel shorter(kRooms + kShut, endless, kBinding, "HoldsAt(At(b2),time)", 9);
  CHECK(shorter.keys().open_ends.cuts.empty());
  CHECK(shorter.keys().open_ends.step == 9);

  // Sixteen rounds lead to the state at 16. Later timepoints are of no execution.
  PlannedModel at(kRooms + kShut, endless, kBinding, "time=16", 20);
  CHECK(at.keys().keys.size() == 1);
  CHECK(at.keys().exploration == Exploration::kAllTracesExplored);
  PlannedModel behind(kRooms + kShut, endless, kBinding, "time=17", 20);
  CHECK(behind.keys().keys.empty());
  CHECK(behind.keys().exploration == Exploration::kCompleteUpToBound);
  CHECK(behind.keys().open_ends.cuts == std::vector<std::size_t>{0});
  // Also where the axioms do not let the plan rest there.
  const std::string always = "[time] time<20 -> Happens(Go(a1),time).\n";
  PlannedModel restless(kRooms + kShut + always, endless, kBinding, "time=17", 20);
  REQUIRE(restless.codes() == "");
  CHECK(restless.keys().keys.empty());
  CHECK(restless.keys().exploration == Exploration::kCompleteUpToBound);
}

TEST_CASE("the longest path of a plan is the horizon where nothing says one") {
  PlannedModel model(kRooms, kPlan, kBinding, "HoldsAt(At(b2),time)", std::nullopt);
  REQUIRE(model.codes() == "");
  CHECK(model.compiled().horizon == 3);
  CHECK(model.keys().exploration == Exploration::kAllTracesExplored);
  PlannedModel cycle(kRooms,
                     "(loop do (perform (an action (type switching) (object (an object "
                     "(name a1))))))",
                     kBinding, "HoldsAt(At(b2),time)", std::nullopt);
  REQUIRE(cycle.codes() == "");
  CHECK(cycle.compiled().horizon == 50);
}

TEST_CASE("repetitions that cannot succeed are dead, those that a change helps are not") {
  const auto dead = [](const std::string& plan, const std::string& start) {
    PlannedModel model(kRooms + start, plan, kBinding, "HoldsAt(Lit(b2),time)", 8);
    REQUIRE(model.compiles());
    std::vector<std::vector<std::size_t>> earlier;
    for (const auto& attempts : compiler::earlier_attempts(model.graph())) {
      earlier.emplace_back();
      for (const auto attempt : attempts) earlier.back().push_back(attempt.index());
    }
    runtime::SolverSession session(model.compiled(), runtime::make_cadical_solver());
    return runtime::dead_steps(session, earlier);
  };
  const auto with_handler = [](const std::string& handler) {
    return "(defparameter *b* (make-pose-stamped \"map\" 0.0 (make-3d-vector 1.5 0 0) "
           "(make-identity-rotation)))\n"
           "(with-retry-counters ((n 2)) (with-failure-handling ((low-level-failure (e) " +
           handler + ")) (perform (an action (type switching) (object (an object (name b2)))))))";
  };
  // From a1 the lamp in b2 cannot be switched, however often.
  CHECK(dead(with_handler("(do-retry n (retry))"), kShut) == std::vector<std::size_t>{1, 2});
  // After driving there it can; only a further retry would be of no use, and is never reached.
  CHECK(
      dead(with_handler("(do-retry n (perform (a motion (type going) (pose *b*))) (retry))"), kShut)
          .empty());
  // If the lamp may be lit, switching it off can be followed by switching it on.
  CHECK(dead(with_handler("(do-retry n (retry))"), "HoldsAt(At(b2),0).\n").empty());
  // No counter: the step repeats itself.
  CHECK(dead(with_handler("(retry)"), kShut) == std::vector<std::size_t>{0});
}

TEST_CASE("a plan's trace is the beginning of an execution that reaches the horizon") {
  // In b2 an alarm happens, where it is quiet; it never is.
  const std::string alarmed =
      kRooms +
      "HoldsAt(At(a1),0).\nfluent Quiet()\nevent Alarm()\n!HoldsAt(Quiet(),0).\n"
      "[time] HoldsAt(At(b2),time) -> Happens(Alarm(),time).\n"
      "[time] Happens(Alarm(),time) -> HoldsAt(At(b2),time) & HoldsAt(Quiet(),time).\n";
  for (const int horizon : {2, 4}) {
    CAPTURE(horizon);
    PlannedModel model(alarmed, kPlan, kBinding, "HoldsAt(At(b2),time)", horizon);
    REQUIRE(model.compiles());
    for (const auto order : {runtime::TraceOrder::kCanonical, runtime::TraceOrder::kAny}) {
      runtime::SolverSession session(model.compiled(), runtime::make_cadical_solver());
      runtime::PlanEnumerator enumerator(session, {.order = order});
      const auto trace = enumerator.next();
      CHECK(trace.has_value() == (horizon == 2));
      if (trace) {
        CHECK(runtime::event_key(*trace) == "Switch(a1);Go(b2);");
        CHECK(!enumerator.next());
        CHECK(!enumerator.dead_end());
      } else {
        CHECK(enumerator.exploration() == runtime::Exploration::kAllTracesExplored);
        CHECK(enumerator.dead_end() == 2);
      }
    }
  }
}

using Fluents = std::vector<compiler::FluentId>;

Fluents among(const Fluents& state, const Fluents& fluents) {
  Fluents out;
  for (const auto id : state) {
    if (runtime::contains(fluents, id)) out.push_back(id);
  }
  return out;
}

TEST_CASE("the initial states of a trace are those that tracing each by itself gives") {
  struct Case {
    std::string text, constraint;
    int horizon;
  };
  const std::vector<Case> cases = {
      {kRooms, "HoldsAt(At(b2),time)", 5},
      {kRooms, "HoldsAt(Lit(b2),time) & {event} Happens(event,time-1)", 6},
      {kRooms + "[time] Releases(Go(b2),Lit(b2),time).\n", "HoldsAt(At(b2),time)", 4},
      {kRooms + "HoldsAt(At(a1),0).\nHoldsAt(Lit(a1),0) | HoldsAt(Lit(b2),0).\n",
       "HoldsAt(At(b2),time)", 4}};
  int several = 0;
  for (const auto& [text, constraint, horizon] : cases) {
    CAPTURE(constraint);
    PlannedModel model(text, kPlan, kBinding, constraint, horizon);
    REQUIRE(model.codes() == "");
    const auto count = static_cast<std::uint32_t>(model.compiled().fluents.size());
    for (std::uint32_t mask = 0; mask < (1U << count); ++mask) {  // what tells states apart
      Fluents told;
      for (std::uint32_t i = 0; i < count; ++i) {
        if ((mask >> i & 1U) != 0) told.emplace_back(i);
      }
      // By key and told state: the states of the first trace in canonical order.
      std::map<std::string, std::map<Fluents, std::vector<Fluents>>> expected;
      runtime::SolverSession split(model.compiled(), runtime::make_cadical_solver());
      runtime::PlanEnumerator each(split, {.split_initial = true});
      while (const auto trace = each.next()) {
        std::vector<Fluents> states;
        for (const auto& point : trace->points) states.push_back(point.holds);
        expected[runtime::event_key(*trace)].emplace(among(states.front(), told), states);
      }
      runtime::SolverSession session(model.compiled(), runtime::make_cadical_solver());
      runtime::PlanEnumerator enumerator(session);
      std::vector<runtime::Trace> traces;
      while (auto trace = enumerator.next()) traces.push_back(*std::move(trace));
      REQUIRE(traces.size() == expected.size());
      for (const auto& trace : traces) {
        const auto& wanted = expected.at(runtime::event_key(trace));
        std::vector<Fluents> states;
        for (const auto& [state, predicted] : wanted) states.push_back(state);
        const auto found = enumerator.initial_states(trace, told, 100);
        CHECK(found.states == states);
        CHECK_FALSE(found.more);
        CHECK(enumerator.initial_states(trace, told, states.size() - 1).more);
        several += states.size() > 1 ? 1 : 0;
        for (const auto& [state, predicted] : wanted) {
          const auto from = enumerator.from(trace, told, state);
          REQUIRE(from.exists == base::Known::kYes);
          CHECK(runtime::event_key(*from.trace) == runtime::event_key(trace));
          std::vector<Fluents> holds;
          for (const auto& point : from.trace->points) holds.push_back(point.holds);
          CHECK(holds == predicted);
        }
        // Whatever else can be told of the fluents is no initial state of the trace.
        for (std::uint32_t other = mask;; other = (other - 1) & mask) {
          Fluents state;
          for (std::uint32_t i = 0; i < count; ++i) {
            if ((other >> i & 1U) != 0) state.emplace_back(i);
          }
          if (!wanted.contains(state)) {
            CHECK(enumerator.from(trace, told, state).exists == base::Known::kNo);
          }
          if (other == 0) break;
        }
        // Each state is one value of each part.
        const auto parts = enumerator.initial_parts(trace, told, 100);
        REQUIRE(parts);
        for (const auto& state : states) {
          for (const auto& values : *parts) {
            Fluents group;
            for (const auto& value : values) group.insert(group.end(), value.begin(), value.end());
            std::sort(group.begin(), group.end());
            group.erase(std::unique(group.begin(), group.end()), group.end());
            const auto value = among(state, group);
            CHECK(std::find(values.begin(), values.end(), value) != values.end());
          }
        }
      }
    }
  }
  CHECK(several > 20);
}

TEST_CASE("alternatives of a trace are noted, and asked about") {
  const std::string released = kRooms +
                               "HoldsAt(At(a1),0).\n!HoldsAt(Lit(a1),0).\n"
                               "[time] Releases(Go(b2),Lit(b2),time).\n";
  PlannedModel model(released, kPlan, kBinding, "HoldsAt(At(b2),time)", 4);
  REQUIRE(model.codes() == "");
  runtime::SolverSession session(model.compiled(), runtime::make_cadical_solver());
  runtime::PlanEnumerator enumerator(session);
  const auto trace = enumerator.next();
  REQUIRE(trace);
  CHECK(runtime::event_key(*trace) == "Switch(a1);Go(b2);");
  CHECK(trace->other_outcomes == base::Known::kYes);  // Lit(b2) is free once the robot has come
  CHECK(trace->other_initial_states == base::Known::kYes);  // Lit(b2) at 0 is open
  const auto fluent = [&](const char* name) { return *trace->symbols->fluent(name); };
  using State = std::map<compiler::FluentId, bool>;
  const auto admits = [&](const State& middle, const State& last) {
    return enumerator.admits(*trace, {{}, middle, last});
  };
  CHECK(admits({}, {{fluent("Lit(b2)"), true}, {fluent("At(b2)"), true}}) == base::Known::kYes);
  CHECK(admits({}, {{fluent("Lit(b2)"), false}}) == base::Known::kYes);
  CHECK(admits({}, {{fluent("At(a1)"), true}}) == base::Known::kNo);
  // Observations along the way count as well.
  CHECK(admits({{fluent("At(a1)"), true}}, {{fluent("Lit(b2)"), true}}) == base::Known::kYes);
  CHECK(admits({{fluent("At(b2)"), true}}, {{fluent("Lit(b2)"), true}}) == base::Known::kNo);
  CHECK(!enumerator.next());
}

TEST_CASE("a constraint that looks ahead of the final timepoint is refused") {
  PlannedModel later(kRooms, kPlan, kBinding, "HoldsAt(At(b2),time+1)", 4);
  CHECK(later.codes() == "E3013");
  PlannedModel event(kRooms, kPlan, kBinding, "Happens(Go(b2),time)", 4);
  CHECK(event.codes() == "E3013");
}

TEST_CASE("an event that is none of the model's is refused at its perform") {
  PlannedModel model(kRooms, kPlan,
                     "motion going (:target ?p) -> Gooo(region(?p)) ok: At(region(?p)) @t+1 else "
                     "navigation-pose-unreachable\n"
                     "action switching (:object ?o) -> Switch(?o) ok: Lit(?o) @t+1 else "
                     "manipulation-low-level-failure\n",
                     "HoldsAt(At(b2),time)", 4);
  CHECK(model.codes() == "E3011");
}

}  // namespace
}  // namespace parallax::test
