// A gate about rates breaks no more often than it says where nothing changed.
#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "harness/confidence/rate_evidence.h"
#include "harness/sampling/sampler.h"
#include "tools/diff/gate.h"

namespace parallax::tools {
namespace {

using harness::CounterRng;

/// Probability of each cause in a run of one trace; the rest is clean.
using Causes = std::vector<double>;

/// Many rare causes, which come and go by chance.
Causes rare_causes(std::size_t count, double each) { return Causes(count, each); }

/// Rates of the given number of runs, or, unless `fixed`, of those up to the tenth discrepancy.
RevisionRates measured(const std::string& events, const Causes& causes, std::int64_t runs,
                       const CounterRng& rng, std::uint64_t first, bool fixed) {
  RevisionRates out{events, {0, 0, 0, fixed}, {}};
  std::map<std::size_t, std::int64_t> counts;
  for (std::int64_t run = 0; run < runs; ++run) {
    double u = rng.uniform(first + static_cast<std::uint64_t>(run));
    ++out.any.runs;
    for (std::size_t c = 0; c < causes.size(); ++c) {
      if (u < causes[c]) {
        ++counts[c];
        ++out.any.failures;
        break;
      }
      u -= causes[c];
    }
    // Ends at its tenth discrepancy, so that the number of runs depends on the outcomes.
    if (!fixed && out.any.failures == 10) break;
  }
  for (const auto& [c, count] : counts) out.causes.push_back({"cause " + std::to_string(c), count});
  return out;
}

RatesRevision revision(const std::string& name, std::vector<RevisionRates> traces, bool fixed) {
  RatesRevision out;
  out.name = name;
  out.compare = "every-step";
  out.complete = true;
  out.fixed = fixed;
  out.traces = std::move(traces);
  return out;
}

struct World {
  const char* name;
  std::vector<Causes> traces;
  std::int64_t runs;
  bool fixed;
};

/// Gates of 1,000 that a rule breaks although both sides are the same.
double broken_share(const World& world, const harness::GateRules::Rates& rules,
                    std::uint64_t seed) {
  constexpr int kGates = 1000;
  int broken = 0;
  for (int gate = 0; gate < kGates; ++gate) {
    const CounterRng rng({.campaign_seed = seed, .sample = static_cast<std::uint64_t>(gate)});
    const auto side = [&](const char* name, std::uint64_t from) {
      std::vector<RevisionRates> traces;
      for (std::size_t t = 0; t < world.traces.size(); ++t) {
        traces.push_back(measured("trace " + std::to_string(t), world.traces[t], world.runs, rng,
                                  from + 1'000'000 * t, world.fixed));
      }
      return revision(name, std::move(traces), world.fixed);
    };
    const auto results = hold_rates(side("old", 0), side("new", 500'000), rules);
    broken += std::any_of(results.begin(), results.end(), [](const RuleResult& one) {
      return one.outcome == RuleOutcome::kBroken;
    });
  }
  return static_cast<double>(broken) / kGates;
}

TEST_CASE("where nothing changed a gate breaks at most as often as it says") {
  const std::vector<World> worlds = {
      {"one cause", {{0.05}}, 100, true},
      {"ten causes", {rare_causes(10, 0.02)}, 100, true},
      {"thirty causes", {rare_causes(30, 0.03)}, 150, true},
      {"two traces of fifteen", {rare_causes(15, 0.04), rare_causes(15, 0.04)}, 120, true},
      {"no fixed number", {rare_causes(10, 0.05)}, 400, false},
  };
  harness::GateRules::Rates causes, worse, both;
  causes.gained_causes = true;
  worse.worse = harness::GateRules::Worse{0.95, 0.001};
  both = worse;
  both.gained_causes = true;
  // 5 %, and three standard errors of a share of 1,000.
  constexpr double kMost = 0.05 + 3.0 * 0.0069;
  for (const auto& world : worlds) {
    for (const auto* rules : {&causes, &worse, &both}) {
      const std::string name = world.name;
      CAPTURE(name);
      CAPTURE(rules->gained_causes);
      CAPTURE(rules->worse.has_value());
      const double share = broken_share(world, *rules, 7);
      MESSAGE(std::string(world.name) << ": " << share);
      CHECK(share <= kMost);
    }
  }
}

TEST_CASE("a cause that is new in many runs breaks the gate among many that came and went") {
  const CounterRng rng({.sample = 3});
  auto causes = rare_causes(20, 0.01);
  const auto before = revision("old", {measured("t", causes, 200, rng, 0, true)}, true);
  causes.push_back(0.1);
  const auto after = revision("new", {measured("t", causes, 200, rng, 1000, true)}, true);
  harness::GateRules::Rates rules;
  rules.gained_causes = true;
  const auto results = hold_rates(before, after, rules);
  REQUIRE(results.size() == 1);
  CHECK(results[0].outcome == RuleOutcome::kBroken);
  CHECK(results[0].words.find("with 95 % confidence not all by chance") != std::string::npos);
  // The witness shows the adjusted p, which is compared with the error, and says so.
  CHECK(results[0].witness.find("adjusted p = ") != std::string::npos);
}

}  // namespace
}  // namespace parallax::tools
