#include "runtime/monitor/belief.h"

#include <doctest/doctest.h>

#include <regex>

#include "tests/runtime/monitor/trace_log.h"
#include "tests/support/planned_model.h"
#include "tests/support/random_model.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

using compiler::EventId;
using runtime::Admission;
using runtime::Belief;
using runtime::BeliefOptions;
using runtime::Beyond;
using runtime::StepWindows;

std::unique_ptr<StepWindows> windows_of(const compiler::CompiledModel& model,
                                        Beyond beyond = Beyond::kTheSame) {
  auto made = runtime::step_windows(model, beyond);
  if (std::holds_alternative<std::string>(made)) return nullptr;
  return std::get<std::unique_ptr<StepWindows>>(std::move(made));
}

Admission feed(Belief& belief, const LogItem& item) {
  if (!item.observed) return belief.step(item.told);
  // Asking beforehand changes nothing, and says the same where nothing is left open.
  const bool agrees = belief.agrees(*item.observed);
  const auto admission = belief.observe(*item.observed, item.one_of);
  if (item.one_of.empty()) CHECK(agrees == (admission != Admission::kRefused));
  if (admission == Admission::kAdmitted) CHECK(agrees);
  return admission;
}

struct Seen {
  std::size_t cases = 0, refused = 0, admitted = 0, unobserved = 0, refusals_late = 0;
  std::size_t several = 0, not_steps = 0;
};

/// A belief, and all traces of each length, over one log.
void compare(const compiler::CompiledModel& model, const StepWindows& windows,
             const std::vector<std::vector<PlainTrace>>& lengths, FuzzRandom& random, Seen& seen) {
  std::vector<bool> unobserved(model.events.size(), false);
  BeliefOptions options;
  if (random.chance(50)) {
    for (std::uint32_t e = 0; e < unobserved.size(); ++e) {
      if (!random.chance(40)) continue;
      unobserved[e] = true;
      options.unobserved.emplace_back(e);
      // Performed in no step while the plan waits: a trace has no such steps (plan_log_test has
      // them).
      options.performed.emplace_back(e);
    }
  }
  // With a small memory, forgotten answers are asked for again.
  if (random.chance(20)) options.remembered = 3;
  const auto log = random_log(model, random.pick(lengths), unobserved, random);
  const auto wanted = admitted_lines(lengths, log, unobserved);
  Belief belief(windows, options);
  std::size_t lines = 0;
  while (lines < log.size()) {
    const auto admission = feed(belief, log[lines]);
    REQUIRE(admission != Admission::kUndecided);
    if (admission == Admission::kRefused) break;
    ++lines;
  }
  CAPTURE(lines);
  CHECK(lines == wanted);
  ++seen.cases;
  ++(wanted < log.size() ? seen.refused : seen.admitted);
  if (wanted < log.size() && wanted > 2) ++seen.refusals_late;
  if (!options.unobserved.empty()) ++seen.unobserved;
  if (belief.largest() > 1) ++seen.several;
}

void compare(const std::string& text, std::uint64_t seed, Seen& seen) {
  const TextModel model(text);
  if (model.ground == nullptr) return;
  const auto windows = windows_of(model.compiled, Beyond::kNothing);
  if (windows == nullptr) {
    ++seen.not_steps;
    return;
  }
  std::vector<std::vector<PlainTrace>> lengths;
  for (compiler::Timepoint n = 0; n <= model.compiled.horizon; ++n) {
    auto traces = plain_traces(model.compiled, n, 400);
    if (!traces) return;
    lengths.push_back(*std::move(traces));
  }
  CAPTURE(text);
  CAPTURE(seed);
  FuzzRandom random(seed);
  for (int i = 0; i < 3; ++i) compare(model.compiled, *windows, lengths, random, seen);
}

}  // namespace

TEST_CASE("what a log leaves possible is what the traces that go with it leave") {
  Seen seen;
  for (std::uint64_t seed = 1; seed <= 1500; ++seed) {
    compare(random_model(seed, kBruteForceSize).print(), seed, seen);
    if (seed % 5 == 0) compare(random_model(seed, kSolverSize).print(), seed, seen);
  }
  MESSAGE(seen.cases, " logs, ", seen.refused, " refused, ", seen.refusals_late, " late, ",
          seen.unobserved, " with unobserved events, ", seen.several, " with several states, ",
          seen.not_steps, " models without steps");
  CHECK(seen.cases > 1000);
  CHECK(seen.refused > 200);
  CHECK(seen.admitted > 200);
  CHECK(seen.refusals_late > 50);
  CHECK(seen.unobserved > 200);
  CHECK(seen.several > 100);
}

/// The same model over another range of timepoints.
std::string over_timepoints(const std::string& text, int last) {
  return std::regex_replace(text, std::regex("range time 0 [0-9]+"),
                            "range time 0 " + std::to_string(last));
}

TEST_CASE("what repeats itself before the horizon goes on behind it") {
  Seen seen;
  for (std::uint64_t seed = 1; seed <= 1500; ++seed) {
    const auto text = random_model(seed, kBruteForceSize).print();
    // A formula about some timepoint allows more if there are more timepoints.
    if (text.find("{time") != std::string::npos) continue;
    const TextModel near(over_timepoints(text, 4)), far(over_timepoints(text, 6));
    if (near.ground == nullptr || far.ground == nullptr) continue;
    const auto windows = windows_of(near.compiled);
    if (windows == nullptr || !windows->goes_on()) continue;
    std::vector<std::vector<PlainTrace>> lengths;
    for (compiler::Timepoint n = 0; n <= far.compiled.horizon; ++n) {
      auto traces = plain_traces(far.compiled, n, 500);
      if (!traces) break;
      lengths.push_back(*std::move(traces));
    }
    if (lengths.size() <= 5 || near.compiled.events.size() != far.compiled.events.size()) continue;
    CAPTURE(text);
    FuzzRandom random(seed);
    const std::vector<bool> unobserved(near.compiled.events.size(), false);
    const auto log = random_log(near.compiled, lengths.back(), unobserved, random);
    Belief belief(*windows, {});
    std::size_t lines = 0;
    while (lines < log.size() && feed(belief, log[lines]) == Admission::kAdmitted) ++lines;
    CHECK(belief.undecided_because().empty());
    CHECK(lines == admitted_lines(lengths, log, unobserved));
    ++seen.cases;
    if (lines < log.size()) ++seen.refused;
  }
  MESSAGE(seen.cases, " logs, ", seen.refused, " refused");
  CHECK(seen.cases > 100);
  CHECK(seen.refused > 20);
}

const std::string kLamps = kTwoRooms + R"(
fluent Lit(room)
event Switch(room)
event Draught(room)
[room,time] HoldsAt(At(room),time) & !HoldsAt(Lit(room),time) -> Initiates(Switch(room),Lit(room),time).
[room,time] HoldsAt(At(room),time) & HoldsAt(Lit(room),time) -> Terminates(Switch(room),Lit(room),time).
[room,time] HoldsAt(Lit(room),time) -> Releases(Draught(room),Lit(room),time).
)";

const std::string kSwitching = kGoing + R"(
action switching (:object ?o) -> Switch(?o)  ok: Lit(?o) @t+1 else manipulation-low-level-failure
)";

const char* const kPlans[] = {
    R"(
(perform (an action (type switching) (object (an object (name a1)))))
(perform (a motion (type going) (pose (make-pose-stamped "map" 0.0 (make-3d-vector 1.5 0 0) (make-identity-rotation)))))
(perform (an action (type switching) (object (an object (name b2)))))
)",
    R"(
(with-retry-counters ((tries 2))
  (with-failure-handling
      ((manipulation-low-level-failure (e)
         (declare (ignore e))
         (do-retry tries
           (perform (a motion (type going) (pose (make-pose-stamped "map" 0.0 (make-3d-vector 1.5 0 0) (make-identity-rotation)))))
           (retry))))
    (perform (an action (type switching) (object (an object (name b2)))))))
)",
    R"(
(loop do (perform (an action (type switching) (object (an object (name a1))))))
)",
};

TEST_CASE("a log is held against where the plan can be, and against what its performs came to") {
  Seen seen;
  for (const std::string plan : kPlans) {
    CAPTURE(plan);
    const PlannedModel planned(kLamps, plan, kSwitching, "HoldsAt(At(b2),time)", 3);
    REQUIRE(planned.codes() == "");
    const auto& model = planned.compiled();
    const auto windows = windows_of(model, Beyond::kNothing);
    REQUIRE(windows != nullptr);
    std::vector<std::vector<PlainTrace>> lengths;
    for (compiler::Timepoint n = 0; n <= model.horizon; ++n) {
      auto traces = plain_traces(model, n, 20000);
      if (!traces) break;
      lengths.push_back(*std::move(traces));
    }
    MESSAGE(lengths.back().size(), " traces of the longest");
    REQUIRE(lengths.size() == 4);
    FuzzRandom random(17);
    for (int i = 0; i < 150; ++i) compare(model, *windows, lengths, random, seen);
  }
  CHECK(seen.refused > 50);
  CHECK(seen.admitted > 50);
}

TEST_CASE("a plan that comes round again is followed without end") {
  const PlannedModel planned(kLamps, kPlans[2], kSwitching, "HoldsAt(At(b2),time)", 4);
  REQUIRE(planned.codes() == "");
  const auto windows = windows_of(planned.compiled());
  REQUIRE(windows != nullptr);
  REQUIRE(windows->goes_on());
  const compiler::SymbolTable symbols(planned.compiled());
  Belief belief(*windows, {});
  runtime::Observation dark(planned.compiled().fluents.size(), 0);
  dark[symbols.fluent("At(a1)")->index()] = 1;
  dark[symbols.fluent("Lit(a1)")->index()] = -1;
  REQUIRE(belief.observe(dark) == Admission::kAdmitted);
  const EventId on = *symbols.event("Switch(a1)"), go = *symbols.event("Go(b2)");
  for (int i = 0; i < 50; ++i) {
    CHECK(belief.step({{on}, true}) == (i == 0 ? Admission::kAdmitted : Admission::kRefused));
    if (i == 0) CHECK(belief.step({{go}, {}}) == Admission::kRefused);
    if (i == 0) continue;
    // Lit already, so switching puts it out: the perform fails, and the plan with it.
    CHECK(belief.step({{on}, false}) == (i == 1 ? Admission::kAdmitted : Admission::kRefused));
  }
  CHECK(belief.plan_may_be_over());
}

TEST_CASE("more states than may be kept are not told apart: nothing is said any more") {
  const TextModel model(
      "range time 0 3\nsort lamp\nlamp L1, L2, L3, L4\nfluent Lit(lamp)\nevent Wait()\n");
  REQUIRE(model.ground != nullptr);
  const auto windows = windows_of(model.compiled);
  REQUIRE(windows != nullptr);
  BeliefOptions options;
  options.max_states = 8;
  Belief belief(*windows, options);
  runtime::Observation seen(4, 0);
  // Sixteen states are too many, but an observation is still compared with them.
  CHECK(belief.observe(seen) == Admission::kAdmitted);
  CHECK_FALSE(belief.size());
  seen[0] = 1;
  CHECK(belief.observe(seen) == Admission::kAdmitted);
  CHECK(belief.size() == std::size_t{8});
  seen[0] = -1;
  CHECK(belief.observe(seen) == Admission::kRefused);
  Belief other(*windows, options);
  CHECK(other.step({{EventId(0)}, {}}) == Admission::kUndecided);
  CHECK(other.undecided_because() == "more than 8 initial states are possible");
  CHECK(other.observe(seen) == Admission::kUndecided);
}

TEST_CASE("what is remembered is bounded, in few states with many different steps as well") {
  std::string text = "range time 0 3\nfluent F()\n";
  for (int e = 0; e < 8; ++e) text += "event E" + std::to_string(e) + "()\n";
  text += "[time] Initiates(E0(),F(),time).\n";
  for (int e = 1; e < 8; ++e) {
    text += "[time] Happens(E" + std::to_string(e) +
            "(),time) -> HoldsAt(F(),time) | !HoldsAt(F(),time).\n";
    text += "[time] HoldsAt(F(),time) -> Terminates(E" + std::to_string(e) + "(),F(),time).\n";
  }
  const TextModel model(text);
  REQUIRE(model.ground != nullptr);
  const auto windows = windows_of(model.compiled);
  REQUIRE(windows != nullptr);
  BeliefOptions options;
  options.remembered = 5;
  Belief belief(*windows, options);
  std::size_t most = 0;
  for (unsigned told = 0; told < 256; told += 2) {
    runtime::ToldStep step;
    for (std::uint32_t e = 0; e < 8; ++e) {
      if ((told >> e & 1U) != 0) step.events.emplace_back(e);
    }
    REQUIRE(belief.step(step) == Admission::kAdmitted);
    most = std::max(most, belief.remembered_ways());
  }
  CHECK(most > 10);
  CHECK(most <= 60);
}

TEST_CASE("axioms about more than two neighbouring timepoints make no steps") {
  const TextModel model(
      "range time 0 4\nfluent F()\nevent E()\n[time] HoldsAt(F(),time) -> HoldsAt(F(),time+2).\n");
  REQUIRE(model.ground != nullptr);
  const auto made = runtime::step_windows(model.compiled);
  REQUIRE(std::holds_alternative<std::string>(made));
  CHECK(std::get<std::string>(made).find("more than two neighbouring timepoints") !=
        std::string::npos);
}

}  // namespace parallax::test
