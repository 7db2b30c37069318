// Traces from elsewhere, checked against a model: the verdict of the solver must be that of brute
// force and of the reference evaluator, whatever the trace leaves open.

#include "runtime/replay/trace_replay.h"

#include <doctest/doctest.h>

#include <filesystem>

#include "compiler/pipeline/compile.h"
#include "runtime/enumerate/model_enumerator.h"
#include "tests/runtime/enumerate/brute_force.h"
#include "tests/support/classic_models.h"
#include "tests/support/random_model.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

using compiler::Valuation;
using runtime::AtomClaims;
using runtime::ClaimedTrace;
using runtime::ReplayVerdict;
using runtime::TraceReplay;
using Kind = ReplayVerdict::Kind;

/// The claims of a file that Parallax writes: every atom that a formula of the model mentions is
/// claimed.
ClaimedTrace claims_of(const Valuation& valuation, const compiler::CompiledModel& model) {
  ClaimedTrace trace;
  trace.number = 1;
  const auto take = [](const std::set<std::string>& names, AtomClaims& claims) {
    claims.closed = true;
    for (const auto& name : names) claims.listed[name] = {true, {}};
  };
  trace.points.resize(valuation.holds.size());
  for (std::size_t t = 0; t < trace.points.size(); ++t) {
    take(valuation.holds[t], trace.points[t].holds);
    take(valuation.happens[t], trace.points[t].happens);
    take(valuation.released[t], trace.points[t].released);
  }
  take(valuation.predicates, trace.predicates);
  std::erase_if(trace.predicates.listed, [&](const auto& entry) {
    return std::none_of(model.fixed.begin(), model.fixed.end(), [&](const compiler::Atom& atom) {
      return atom.kind == compiler::AtomKind::kPredicate && atom.name == entry.first;
    });
  });
  return trace;
}

/// Does the valuation differ from the claims in no atom of which they say something?
bool extends(const Valuation& valuation, const ClaimedTrace& trace) {
  const auto fits = [](const std::set<std::string>& names, const AtomClaims& claims) {
    for (const auto& name : names) {
      if (claims.value(name) == false) return false;
    }
    for (const auto& [name, claim] : claims.listed) {
      if (claim.value != names.contains(name)) return false;
    }
    return true;
  };
  for (std::size_t t = 0; t < trace.points.size(); ++t) {
    const auto& point = trace.points[t];
    if (!fits(valuation.holds[t], point.holds) || !fits(valuation.happens[t], point.happens) ||
        !fits(valuation.released[t], point.released)) {
      return false;
    }
  }
  return fits(valuation.predicates, trace.predicates);
}

/// A random atom gets the other value, or none: one out of three stays unsaid.
void edit(const compiler::CompiledModel& model, FuzzRandom& random, ClaimedTrace& trace) {
  const auto t = random.below(trace.points.size());
  auto& point = trace.points[t];
  AtomClaims* claims = &point.holds;
  std::string name;
  const bool event = t + 1 < trace.points.size() && !model.events.empty() && random.chance(40);
  if (event) {
    claims = &point.happens;
    name = random.pick(model.events).name;
  } else if (!model.fluents.empty()) {
    name = random.pick(model.fluents).name;
    if (random.chance(20)) claims = &point.released;
  }
  if (name.empty()) return;
  const auto before = claims->value(name);
  claims->listed[name] = {!before.value_or(false), {}};
}

std::set<std::string> truths(const AtomClaims& claims) {
  std::set<std::string> names;
  for (const auto& [name, claim] : claims.listed) {
    if (claim.value) names.insert(name);
  }
  return names;
}

void hide(FuzzRandom& random, ClaimedTrace& trace) {
  for (auto& point : trace.points) {
    if (random.chance(30)) point.holds = {};
    if (random.chance(30)) point.happens = {};
    if (random.chance(60)) point.released = {};
  }
  if (random.chance(60)) trace.predicates = {};
}

struct Tally {
  int models = 0, agreed = 0, failed = 0, hidden = 0, blamed = 0;
};

/// The failing timepoint and the blamed origins, by the definition of both.
void check_failure(const TextModel& model, const TraceReplay& replay, const ClaimedTrace& trace,
                   const ReplayVerdict& verdict, Tally& tally) {
  CHECK(verdict.timepoint >= 0);
  CHECK(verdict.timepoint <= trace.length());
  if (verdict.impossible) return;
  const auto core = replay.blame(trace, verdict.timepoint);
  REQUIRE(core.status == runtime::SolveStatus::kUnsatisfiable);
  CHECK(!core.origins.empty());
  for (const auto origin : core.origins) CHECK(origin < model.compiled.origins.size());
  ++tally.blamed;
}

void check_model(std::uint64_t seed, Tally& tally) {
  CAPTURE(seed);
  const TextModel model(random_model(seed, kBruteForceSize).print());
  if (model.ground == nullptr) return;
  BruteForce brute(*model.typed);
  if (brute.open_atoms() > 12) return;
  std::vector<Valuation> all;
  brute.for_each([&](const auto& values) { all.push_back(brute.valuation(values)); });
  if (all.empty()) return;
  ++tally.models;
  TraceReplay replay(model.compiled, [] { return runtime::make_cadical_solver(); });
  FuzzRandom random(seed);
  for (int round = 0; round < 12; ++round) {
    auto trace = claims_of(random.pick(all), model.compiled);
    for (auto edits = random.below(3); edits > 0; --edits) edit(model.compiled, random, trace);
    if (random.chance(50)) hide(random, trace);
    const bool wanted = std::any_of(all.begin(), all.end(), [&](const Valuation& valuation) {
      return extends(valuation, trace);
    });
    const auto verdict = replay.replay(trace);
    REQUIRE(verdict.kind == (wanted ? Kind::kAgrees : Kind::kFails));
    if (verdict.hidden > 0) ++tally.hidden;
    if (!wanted) {
      ++tally.failed;
      check_failure(model, replay, trace, verdict, tally);
      continue;
    }
    ++tally.agreed;
    auto completed = tools::valuation_of(verdict.completion);
    CHECK(!brute.evaluator().check(completed).has_value());
    CHECK(extends(completed, trace));
  }
}

TEST_CASE("edited and incomplete traces of random models: brute force gives the same verdict") {
  Tally tally;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) check_model(seed, tally);
  CAPTURE(tally.models);
  CHECK(tally.models > 100);
  CHECK(tally.agreed > 300);
  CHECK(tally.failed > 300);
  CHECK(tally.hidden > 100);
  CHECK(tally.blamed > 200);
}

TEST_CASE("single edits of traces of the classic problems: the evaluator gives the same verdict") {
  int models = 0, failed = 0, agreed = 0;
  for_each_classic([&](const compiler::Compilation& compiled) {
    const compiler::ReferenceEvaluator evaluator(*compiled.typed);
    REQUIRE(!evaluator.refusal());
    runtime::SolverSession session(compiled.model, runtime::make_cadical_solver());
    runtime::ModelEnumerator enumerator(session);
    const auto trace = enumerator.next();
    if (!trace) return;
    ++models;
    TraceReplay replay(compiled.model, [] { return runtime::make_cadical_solver(); });
    FuzzRandom random(static_cast<std::uint64_t>(models));
    for (int round = 0; round < 20; ++round) {
      auto valuation = tools::valuation_of(*trace);
      auto claims = claims_of(valuation, compiled.model);
      if (round > 0) edit(compiled.model, random, claims);
      for (std::size_t t = 0; t < claims.points.size(); ++t) {
        valuation.holds[t] = truths(claims.points[t].holds);
        valuation.happens[t] = truths(claims.points[t].happens);
        valuation.released[t] = truths(claims.points[t].released);
      }
      const auto verdict = replay.replay(claims);
      CHECK(verdict.hidden == 0);
      CHECK((verdict.kind == Kind::kAgrees) == !evaluator.check(valuation).has_value());
      ++(verdict.kind == Kind::kAgrees ? agreed : failed);
    }
  });
  CHECK(models > 15);
  CHECK(agreed >= models);
  CHECK(failed > 200);
}

constexpr const char* kLamp =
    "range time 0 2\nfluent On()\nfluent Broken()\nevent Press()\n"
    "[time] !HoldsAt(Broken(),time) -> Initiates(Press(),On(),time).\n"
    "!HoldsAt(On(),0).\n";

ClaimedTrace lamp(const std::vector<bool>& on, const std::vector<bool>& pressed) {
  ClaimedTrace trace;
  trace.points.resize(on.size());
  for (std::size_t t = 0; t < on.size(); ++t) {
    trace.points[t].holds.listed["On()"] = {on[t], {}};
    if (t < pressed.size()) trace.points[t].happens.listed["Press()"] = {pressed[t], {}};
  }
  return trace;
}

TEST_CASE("what is left open gets values: the lamp that stays dark is broken") {
  const TextModel model(kLamp);
  TraceReplay replay(model.compiled, [] { return runtime::make_cadical_solver(); });
  const auto verdict = replay.replay(lamp({false, false, false}, {true, false}));
  REQUIRE(verdict.kind == Kind::kAgrees);
  CHECK(verdict.hidden == 3);
  CHECK(verdict.completion.holds(0) == runtime::Names{"Broken()"});
}

TEST_CASE("the first timepoint that fails is named, and a core of what it contradicts") {
  const TextModel model(kLamp);
  TraceReplay replay(model.compiled, [] { return runtime::make_cadical_solver(); });
  auto trace = lamp({false, true, false}, {true, false});
  const auto verdict = replay.replay(trace);
  REQUIRE(verdict.kind == Kind::kFails);
  CHECK(verdict.timepoint == 2);
  const auto core = replay.blame(trace, 2);
  REQUIRE(core.status == runtime::SolveStatus::kUnsatisfiable);
  REQUIRE(core.origins.size() == 1);
  CHECK(model.compiled.origins[core.origins.front()].kind == compiler::OriginKind::kFrameAxiom);
}

TEST_CASE("with no values of the rest, several origins are blamed together") {
  const TextModel model(kLamp);
  TraceReplay replay(model.compiled, [] { return runtime::make_cadical_solver(); });
  // Dark after one press, so broken; bright after the second, so not broken.
  const auto trace = lamp({false, false, true}, {true, true});
  const auto verdict = replay.replay(trace);
  REQUIRE(verdict.kind == Kind::kFails);
  CHECK(verdict.timepoint == 2);
  const auto core = replay.blame(trace, 2);
  REQUIRE(core.status == runtime::SolveStatus::kUnsatisfiable);
  CHECK(core.origins.size() > 1);
}

TEST_CASE("a raised stop gives no verdict") {
  const TextModel model(kLamp);
  const std::atomic<bool> stop = true;
  TraceReplay replay(model.compiled, [&] { return runtime::make_cadical_solver(&stop); });
  CHECK(replay.replay(lamp({false, true, false}, {true, false})).kind == Kind::kUnknown);
}

}  // namespace
}  // namespace parallax::test
