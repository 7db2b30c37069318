#include "harness/campaign/rates.h"

#include "harness/campaign/run_setup.h"
#include "harness/sampling/sampler.h"
#include "tests/harness/campaign/two_regions.h"

namespace parallax::harness::test {
namespace {

struct RatesBench : Bench {
  RatesOptions rates;
  base::Result<RatesResult> estimate() {
    ListFeed feed(traces, openness);
    const auto factory = [this] { return std::make_unique<ScriptedSimulator>(script); };
    return estimate_rates(scenario, feed, factory, rates, sink);
  }
};

TEST_CASE("what is counted is what the drawn starts lead to, cause by cause") {
  RatesBench bench;
  bench.rates.runs = 100;
  bench.rates.jobs = 3;
  bench.script.drops = box_far;
  std::int64_t expected = 0, first = 0;
  for (std::int64_t sample = 1; sample <= 100; ++sample) {
    if (!box_far(drawn_start(bench, 1, sample))) continue;
    if (expected++ == 0) first = sample;
  }
  REQUIRE(expected > 0);
  const auto result = bench.estimate();
  REQUIRE(result.has_value());
  CHECK(result->complete);
  REQUIRE(result->traces.size() == 1);
  const auto& trace = result->traces[0];
  CHECK(trace.number == 1);
  CHECK(trace.trace == "Go(r2) PickUp() Go(r1) Place()");
  CHECK(trace.runs == 100);
  CHECK(trace.lost == 0);
  CHECK(trace.any.count == expected);
  REQUIRE(trace.causes.size() == 1);
  CHECK(trace.causes[0].cause == "PickUp(): slipped");
  CHECK(trace.causes[0].count == expected);
  CHECK(trace.causes[0].example == first);
  CHECK(trace.causes[0].reason == "slipped");
  CHECK(trace.causes[0].start == drawn_start(bench, 1, first));
  CHECK(trace.causes[0].lower < trace.causes[0].rate);
  CHECK(trace.causes[0].upper > trace.causes[0].rate);
}

/// P(X <= count) of a binomial variable, summed term by term.
double binomial_below(std::int64_t count, std::int64_t runs, double p) {
  double sum = 0.0;
  for (std::int64_t k = 0; k <= count; ++k) {
    double term = 1.0;
    for (std::int64_t i = 0; i < k; ++i) {
      term *= p * static_cast<double>(runs - i) / static_cast<double>(k - i);
    }
    for (std::int64_t i = k; i < runs; ++i) term *= 1.0 - p;
    sum += term;
  }
  return sum;
}

TEST_CASE("a lost run may have been either: intervals reach from the best to the worst case") {
  RatesBench bench;
  bench.rates.runs = 60;
  bench.rates.jobs = 2;
  bench.script.seeds = false;
  bench.scenario.limits.max_lost_in_a_row = 30;
  bench.script.drops = box_far;
  bench.script.loses = [](const State& start) {
    const double x = number(start, "box.x");
    return x > 1.5 && x < 1.7;
  };
  const auto result = bench.estimate();
  REQUIRE(result.has_value());
  const auto& trace = result->traces[0];
  REQUIRE(trace.lost > 0);
  REQUIRE(trace.any.count > 0);
  CHECK(trace.runs + trace.lost == 60);
  CHECK(trace.unseen == trace.lost);
  CHECK(trace.any.rate ==
        doctest::Approx(static_cast<double>(trace.any.count) / static_cast<double>(trace.runs)));
  CHECK(1.0 - binomial_below(trace.any.count - 1, 60, trace.any.lower) ==
        doctest::Approx(0.025).epsilon(1e-6));
  CHECK(binomial_below(trace.any.count + trace.lost, 60, trace.any.upper) ==
        doctest::Approx(0.025).epsilon(1e-6));
}

TEST_CASE("until the interval is narrow: the same runs for any jobs, and no more than it takes") {
  std::vector<RatesResult> results;
  for (const int jobs : {1, 4}) {
    RatesBench bench;
    bench.rates.runs = 5000;
    bench.rates.jobs = jobs;
    bench.rates.until_width = 0.25;
    bench.script.drops = box_far;
    auto result = bench.estimate();
    REQUIRE(result.has_value());
    results.push_back(*std::move(result));
  }
  const auto& trace = results[0].traces[0];
  CHECK(trace.any.upper - trace.any.lower <= 0.25);
  CHECK(trace.runs > 20);
  CHECK(trace.runs < 500);
  CHECK(trace.any.lower < trace.any.rate);
  CHECK(trace.any.upper > trace.any.rate);
  CHECK(results[1].traces[0].runs == trace.runs);
  CHECK(results[1].traces[0].any.count == trace.any.count);
  CHECK(results[1].traces[0].any.upper == trace.any.upper);
}

TEST_CASE("an interval that holds whenever one looks is missed by the worst peeker that seldom") {
  // Looks after every one of 400 runs and takes it for false as soon as p is outside.
  constexpr std::uint64_t kLoops = 2000;
  for (const double p : {0.02, 0.3}) {
    std::uint64_t missed = 0;
    for (std::uint64_t loop = 0; loop < kLoops; ++loop) {
      const CounterRng rng({.campaign_seed = 99, .sample = loop});
      CauseRate rate;
      for (std::int64_t run = 1; run <= 400; ++run) {
        if (rng.uniform(static_cast<std::uint64_t>(run)) < p) ++rate.count;
        if (run % 5 != 0) continue;
        set_anytime_interval(rate, run, 0, 0.95);
        if (rate.lower <= p && p <= rate.upper) continue;
        ++missed;
        break;
      }
    }
    // 5 % and four standard errors.
    CHECK(missed <= 2000 * 0.05 + 4 * std::sqrt(2000 * 0.05 * 0.95));
  }
}

TEST_CASE("where losses end it, what was not made may have been either, too") {
  RatesBench bench;
  bench.rates.runs = 40;
  bench.scenario.limits.max_lost_in_a_row = 3;
  bench.script.seeds = false;
  std::atomic<int> resets = 0;
  bench.script.resets = &resets;
  bench.script.drops = [](const State&) { return true; };
  bench.script.loses = [&](const State&) { return resets > 20; };
  const auto result = bench.estimate();
  REQUIRE(result.has_value());
  CHECK_FALSE(result->complete);
  const auto& trace = result->traces[0];
  CHECK(trace.any.count == trace.runs);
  CHECK(trace.unseen == 40 - trace.runs);
  CHECK(1.0 - binomial_below(trace.runs - 1, 40, trace.any.lower) ==
        doctest::Approx(0.025).epsilon(1e-6));
  CHECK(trace.any.upper == 1.0);
}

TEST_CASE("a simulator that does not start where it was put gives no rate") {
  RatesBench bench;
  bench.rates.runs = 3;
  // The robot begins in r2 and still ends as predicted.
  bench.script.start_shift_m = 1.0;
  CHECK_FALSE(bench.estimate().has_value());
  CHECK(codes(bench.sink) == std::vector<std::string>{"E7112"});
}

TEST_CASE("neither does one that does not show what is compared, or refuses a request") {
  RatesBench bench;
  bench.rates.runs = 3;
  SUBCASE("an action") { bench.script.refuses = "placing"; }
  SUBCASE("a variable") { bench.script.hides_box = true; }
  CHECK_FALSE(bench.estimate().has_value());
  CHECK(codes(bench.sink) == std::vector<std::string>{"E7109"});
}

TEST_CASE("nor one that cannot be put into the start") {
  RatesBench bench;
  bench.script.box_settable = false;
  CHECK_FALSE(bench.estimate().has_value());
  CHECK(codes(bench.sink) == std::vector<std::string>{"E5116"});
}

TEST_CASE("starts that are always invalid end it") {
  RatesBench bench;
  bench.script.invalid = [](const State&) { return true; };
  CHECK_FALSE(bench.estimate().has_value());
  CHECK(codes(bench.sink) == std::vector<std::string>{"E7105"});
}

TEST_CASE("losses in a row end it with what was counted, also from one trace to the next") {
  RatesBench bench;
  bench.traces = 3;
  bench.rates.runs = 2;
  bench.scenario.limits.max_lost_in_a_row = 3;
  std::atomic<int> resets = 0;
  bench.script.resets = &resets;
  bench.script.loses = [](const State&) { return true; };
  bench.script.seeds = false;
  const auto result = bench.estimate();
  REQUIRE(result.has_value());
  CHECK_FALSE(result->complete);
  CHECK(codes(bench.sink) == std::vector<std::string>{"E7107"});
  CHECK(bench.sink.exit_code() == 4);
  REQUIRE(result->traces.size() == 2);
  CHECK(result->traces[0].lost == 2);
  CHECK(result->traces[1].lost == 1);
  CHECK(result->traces[1].runs == 0);
}

TEST_CASE("an end that the model admits is no discrepancy, unless only the trace counts") {
  RatesBench bench;
  bench.rates.runs = 5;
  bench.script.drops = [](const State&) { return true; };
  bench.openness.outcomes = true;
  bench.openness.admits = [](const auto&) { return true; };
  std::int64_t expected = 0;
  SUBCASE("the model counts") {}
  SUBCASE("only the trace counts") { bench.scenario.match_model = false, expected = 5; }
  const auto result = bench.estimate();
  REQUIRE(result.has_value());
  CHECK(result->traces[0].any.count == expected);
  CHECK(result->traces[0].runs == 5);
}

TEST_CASE("the stop flag leaves what was counted") {
  RatesBench bench;
  std::atomic<bool> stop = false;
  bench.rates.stop = &stop;
  int acts = 0;
  bench.script.on_act = [&] {
    if (++acts == 10) stop = true;
  };
  const auto result = bench.estimate();
  REQUIRE(result.has_value());
  CHECK_FALSE(result->complete);
  REQUIRE(result->traces.size() == 1);
  CHECK(result->traces[0].runs <= 2);
}

}  // namespace
}  // namespace parallax::harness::test
