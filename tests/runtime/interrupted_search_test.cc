// A search that is stopped at any solver call: every answer is right or says that it is undecided.

#include <doctest/doctest.h>

#include <algorithm>

#include "runtime/compare/trace_difference.h"
#include "runtime/enumerate/dead_steps.h"
#include "runtime/enumerate/model_enumerator.h"
#include "runtime/enumerate/plan_enumerator.h"
#include "runtime/explain/contradiction.h"
#include "runtime/explain/why.h"
#include "runtime/replay/trace_replay.h"
#include "tests/support/planned_model.h"
#include "tests/support/stopping_solver.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

using base::Known;
using runtime::Exploration;
using runtime::SolveStatus;

std::unique_ptr<runtime::SatSolver> stopped_by(StopAt& stop) {
  return std::make_unique<StoppingSolver>(stop);
}

bool is_right(Known answer, Known full) { return answer == Known::kUndecided || answer == full; }

/// Two rooms, a lamp in each; a switch works only where the robot is, and whether the lamp in b2
/// shines is open once it came there.
const std::string kRooms = kTwoRooms + R"(
fluent Lit(room)
event Switch(room)
[room,time] HoldsAt(At(room),time) & !HoldsAt(Lit(room),time) -> Initiates(Switch(room),Lit(room),time).
[room,time] HoldsAt(At(room),time) & HoldsAt(Lit(room),time) -> Terminates(Switch(room),Lit(room),time).
[time] Releases(Go(b2),Lit(b2),time).
)";
const std::string kBinding = kGoing + R"(
action switching (:object ?o) -> Switch(?o)  ok: Lit(?o) @t+1 else manipulation-low-level-failure
)";
const std::string kPlan = R"(
(let ((?b (make-pose-stamped "map" 0.0 (make-3d-vector 1.5 0 0) (make-identity-rotation))))
  (perform (an action (type switching) (object (an object (name a1)))))
  (perform (a motion (type going) (pose ?b)))
  (perform (an action (type switching) (object (an object (name b2))))))
)";

/// Results of an enumeration with a plan, in order.
struct Told {
  std::vector<std::string> keys;
  std::vector<Known> initial_states, outcomes, admitted;
  Exploration exploration = Exploration::kStopped;
  runtime::OpenEnds open_ends;
};

Told enumerate(const compiler::CompiledModel& model, StopAt& stop) {
  runtime::SolverSession session(model, stopped_by(stop));
  runtime::PlanEnumerator enumerator(session);
  Told told;
  while (const auto trace = enumerator.next()) {
    told.keys.push_back(runtime::event_key(*trace));
    told.initial_states.push_back(trace->other_initial_states);
    told.outcomes.push_back(trace->other_outcomes);
    std::vector<std::map<compiler::FluentId, bool>> observed(trace->points.size());
    observed.back()[*trace->symbols->fluent("Lit(b2)")] = false;
    told.admitted.push_back(enumerator.admits(*trace, observed));
  }
  CHECK(!enumerator.next());
  told.exploration = enumerator.exploration();
  told.open_ends = enumerator.open_ends();
  return told;
}

void check_told(const Told& told, const Told& full) {
  REQUIRE(told.keys.size() <= full.keys.size());
  for (std::size_t i = 0; i < told.keys.size(); ++i) {
    CHECK(told.keys[i] == full.keys[i]);
    CHECK(is_right(told.initial_states[i], full.initial_states[i]));
    CHECK(is_right(told.outcomes[i], full.outcomes[i]));
    CHECK(is_right(told.admitted[i], full.admitted[i]));
  }
  if (told.exploration == Exploration::kStopped) {
    CHECK(told.open_ends.cuts.empty());
    CHECK(!told.open_ends.step);
    return;
  }
  CHECK(told.exploration == full.exploration);
  CHECK(told.keys == full.keys);
  CHECK(told.open_ends.cuts == full.open_ends.cuts);
  CHECK(told.open_ends.step == full.open_ends.step);
}

TEST_CASE("traces of a plan: what is found is right, the rest is called stopped") {
  struct Case {
    std::string plan, constraint;
    int horizon;
    Exploration end;
  };
  const std::string endless = R"(
(defun drive (?x) (perform (a motion (type going) (pose (make-pose-stamped "map" 0.0
  (make-3d-vector ?x 0 0) (make-identity-rotation))))))
(let ((?n 0)) (loop do (incf ?n) (drive 1.5) (drive 0.5)))
)";
  for (const auto& [plan, constraint, horizon, end] :
       {Case{kPlan, "HoldsAt(At(b2),time)", 5, Exploration::kAllTracesExplored},
        Case{kPlan, "HoldsAt(Lit(b2),time) & {event} Happens(event,time-1)", 2,
             Exploration::kCompleteUpToBound},
        Case{endless, "HoldsAt(Lit(a1),time) & !HoldsAt(Lit(a1),time)", 20,
             Exploration::kCompleteUpToBound}}) {
    const PlannedModel model(kRooms, plan, kBinding, constraint, horizon);
    REQUIRE(model.compiles());
    StopAt never(INT64_MAX);
    const auto full = enumerate(model.compiled(), never);
    CHECK(full.exploration == end);
    const auto calls = sweep_stops([&](StopAt& stop) {
      CAPTURE(stop.call);
      check_told(enumerate(model.compiled(), stop), full);
    });
    CHECK(calls == never.calls);
    CHECK(calls > 10);
  }
}

TEST_CASE("traces one by one and by the tree: none is wrong, and no stop is called the end") {
  const TextModel model(
      "range time 0 2\nfluent F()\nfluent G()\nevent E()\nevent D()\n"
      "[time] Initiates(E(),F(),time).\n[time] Terminates(D(),G(),time).\n"
      "[time] !(Happens(E(),time) & Happens(D(),time)).\n");
  REQUIRE(model.codes() == "");
  StopAt never(INT64_MAX);
  runtime::SolverSession full_session(model.compiled, stopped_by(never));
  runtime::ModelEnumerator full_source(full_session);
  std::vector<std::string> full;
  while (const auto trace = full_source.next()) full.push_back(runtime::to_jsonl(*trace));
  CHECK(full.size() == 36);
  sweep_stops([&](StopAt& stop) {
    CAPTURE(stop.call);
    runtime::SolverSession session(model.compiled, stopped_by(stop));
    runtime::ModelEnumerator source(session);
    std::size_t count = 0;
    while (source.next()) ++count;
    CHECK((!source.exhausted() || count == full.size()));
  });
  for (const auto make : {runtime::make_trace_tree, runtime::make_guarded_blocking}) {
    sweep_stops([&](StopAt& stop) {
      CAPTURE(stop.call);
      runtime::SolverSession session(model.compiled, stopped_by(stop));
      const auto source = make(session, runtime::Distinct::kObservable);
      std::size_t count = 0;
      while (const auto trace = source->next()) {
        REQUIRE(count < full.size());
        CHECK(runtime::to_jsonl(*trace) == full[count++]);
      }
      CHECK(!source->next());  // and none later
      CHECK((!source->exhausted() || count == full.size()));
    });
  }
}

constexpr const char* kImpossible =
    "range time 0 2\nfluent F()\nfluent G()\nevent E()\n"
    "HoldsAt(G(),0).\nHoldsAt(F(),0).\n[time] Initiates(E(),G(),time).\n!HoldsAt(F(),2).\n";
constexpr const char* kPossible = "range time 0 2\nfluent F()\nevent E()\nHoldsAt(F(),0).\n";

TEST_CASE("cores: a possible model has none, and what was not tried is not called minimal") {
  for (const auto& [text, status] : {std::pair(kImpossible, SolveStatus::kUnsatisfiable),
                                     std::pair(kPossible, SolveStatus::kSatisfiable)}) {
    const TextModel model(text);
    REQUIRE(model.codes() == "");
    const auto full = runtime::find_unsat_core(model.compiled, 2, runtime::make_cadical_solver());
    CHECK(full.status == status);
    sweep_stops([&](StopAt& stop) {
      CAPTURE(stop.call);
      const auto core = runtime::find_unsat_core(model.compiled, 2, stopped_by(stop));
      if (core.status == SolveStatus::kUnknown) {
        CHECK(stop.call == 0);
        return;
      }
      CHECK(core.status == full.status);
      if (core.is_minimal) CHECK(core.origins == full.origins);
      CHECK(std::includes(core.origins.begin(), core.origins.end(), full.origins.begin(),
                          full.origins.end()));
    });
  }
}

TEST_CASE("minimal sets: neither is a contradiction denied nor one made up") {
  for (const auto* text : {kImpossible, kPossible}) {
    const TextModel model(text);
    runtime::ExecutionFormula formula(model.compiled);
    const auto axioms = runtime::group_axioms(model.compiled);
    const bool possible = text == kPossible;
    const auto check = [&](const runtime::MinimalSets& found, const StopAt& stop) {
      CAPTURE(stop.call);
      CHECK(found.unknown == (found.sets.empty() && !found.proven));
      if (possible) CHECK(found.sets.empty());
      if (!possible && found.proven) CHECK(found.sets.size() == 1);
      if (!stop.is_reached()) CHECK(found.proven);
      for (const auto& set : found.sets) {
        auto solver = runtime::load_axioms(formula, axioms, runtime::make_cadical_solver());
        CHECK(solver.solve(set) == SolveStatus::kUnsatisfiable);
      }
    };
    sweep_stops([&](StopAt& stop) {
      auto solver = runtime::load_axioms(formula, axioms, stopped_by(stop));
      check(runtime::smallest_set(solver, &stop.flag), stop);
    });
    sweep_stops([&](StopAt& stop) {
      auto solver = runtime::load_axioms(formula, axioms, stopped_by(stop));
      check(runtime::all_minimal_sets(solver, 0, &stop.flag), stop);
    });
  }
}

TEST_CASE("repetitions are dead only where that was shown") {
  const std::string plan = R"(
(with-retry-counters ((n 2))
  (with-failure-handling
      ((manipulation-low-level-failure (e) (do-retry n (retry))))
    (perform (an action (type switching) (object (an object (name b2)))))))
)";
  const PlannedModel model(kRooms + "HoldsAt(At(a1),0).\n!HoldsAt(Lit(b2),0).\n", plan, kBinding,
                           "HoldsAt(Lit(b2),time)", 6);
  REQUIRE(model.compiles());
  std::vector<std::vector<std::size_t>> earlier(model.compiled().plan.size());
  for (std::size_t step = 1; step < earlier.size(); ++step) earlier[step] = {step - 1};
  runtime::SolverSession session(model.compiled(), runtime::make_cadical_solver());
  const auto full = runtime::dead_steps(session, earlier);
  CHECK(!full.empty());
  sweep_stops([&](StopAt& stop) {
    runtime::SolverSession stopped(model.compiled(), stopped_by(stop));
    const auto found = runtime::dead_steps(stopped, earlier);
    CHECK(std::includes(full.begin(), full.end(), found.begin(), found.end()));
  });
}

TEST_CASE("a replayed trace fails only where it does") {
  const TextModel model(kPossible);
  for (const bool fails : {false, true}) {
    runtime::ClaimedTrace trace;
    trace.points.resize(3);
    trace.points[2].holds.listed["F()"] = {!fails, {}};
    const auto kind =
        fails ? runtime::ReplayVerdict::Kind::kFails : runtime::ReplayVerdict::Kind::kAgrees;
    const auto calls = sweep_stops([&](StopAt& stop) {
      CAPTURE(stop.call);
      runtime::TraceReplay replay(model.compiled, [&] { return stopped_by(stop); });
      const auto verdict = replay.replay(trace);
      if (!stop.is_reached()) CHECK(verdict.kind == kind);
      if (verdict.kind != runtime::ReplayVerdict::Kind::kUnknown) CHECK(verdict.kind == kind);
      if (!fails) return;
      const auto core = replay.blame(trace, 2);
      if (core.status != SolveStatus::kUnknown) {
        CHECK(core.status == SolveStatus::kUnsatisfiable);
        CHECK(!core.origins.empty());
      }
    });
    CHECK(calls > 0);
  }
}

TEST_CASE("whether a fact was chosen is not said by a solver that was stopped") {
  const TextModel model(
      "range time 0 1\nfluent F()\nfluent G()\nevent E()\n"
      "HoldsAt(F(),0) | HoldsAt(G(),0).\n");
  runtime::SolverSession session(model.compiled, runtime::make_cadical_solver());
  REQUIRE(session.solve(1, {}) == SolveStatus::kSatisfiable);
  std::vector<bool> values;
  for (std::int32_t v = 1; v <= model.compiled.variable_count(); ++v) {
    values.push_back(session.value(runtime::Literal::positive(v)));
  }
  const auto atom =
      compiler::AtomIndex(model.compiled).find(compiler::AtomKind::kHoldsAt, "F()", 0);
  REQUIRE(atom);
  const auto fact = session.value(*atom) ? *atom : ~*atom;
  runtime::WhyOptions options;
  CHECK(runtime::explain_fact(model.compiled, 1, values, fact, options).back().kind ==
        runtime::WhyKind::kChosen);
  const std::atomic<bool> stop{true};
  options.stop = &stop;
  CHECK(runtime::explain_fact(model.compiled, 1, values, fact, options).back().kind ==
        runtime::WhyKind::kUndecided);
}

TEST_CASE("two models that were not compared are not called equal") {
  const TextModel first(kPossible), second(kImpossible);
  const std::atomic<bool> stop{true};
  runtime::DifferenceOptions options;
  options.stop = &stop;
  const auto found = runtime::compare_traces(first.compiled, second.compiled, options);
  CHECK(found.lost.answer == runtime::DifferenceAnswer::kUnknown);
  CHECK(found.gained.answer == runtime::DifferenceAnswer::kUnknown);
  CHECK(!found.lost.count.exact);
  CHECK(!found.first_count);
}

}  // namespace
}  // namespace parallax::test
