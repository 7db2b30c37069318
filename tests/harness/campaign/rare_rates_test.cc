#include "harness/campaign/rare_rates.h"

#include <nlohmann/json.hpp>

#include "harness/report/report.h"
#include "tests/harness/campaign/two_regions.h"

namespace parallax::harness::test {
namespace {

/// One start in fifty goes wrong: those with the box in the last two centimetres.
struct RareBench : Bench {
  RatesOptions rates;
  RareEventMethod method = RareEventMethod::kImportance;

  explicit RareBench(const std::string& more = "") : Bench(std::string(kScenarioText) + more) {
    rates.runs = 2000;
    script.drops = [](const State& start) { return number(start, "box.x") > 1.98; };
  }
  base::Result<RareRatesResult> estimate() {
    ListFeed feed(traces, openness);
    const auto factory = [this] { return std::make_unique<ScriptedSimulator>(script); };
    return estimate_rare_rates(scenario, feed, factory, rates, method, sink);
  }
};

bool report_says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_CASE(
    "rare rates: the interval holds, the same for any jobs, and the report names the method") {
  std::vector<std::string> documents;
  for (const int jobs : {1, 4}) {
    RareBench bench;
    bench.rates.jobs = jobs;
    const auto result = bench.estimate();
    REQUIRE(result.has_value());
    CHECK(result->is_answered());
    REQUIRE(result->traces.size() == 1);
    const auto& estimate = result->traces[0].estimate;
    CHECK(result->traces[0].trace == "Go(r2) PickUp() Go(r1) Place()");
    CHECK(estimate.runs == 2000);
    CHECK(estimate.lower > 0.0);
    CHECK(estimate.lower <= 0.02);
    CHECK(estimate.upper >= 0.02);
    CHECK(estimate.upper < 0.06);
    const auto text = rates_text(*result);
    CHECK(report_says(text, "by importance: they hold whatever the simulator does"));
    CHECK(report_says(text, "any discrepancy"));
    documents.push_back(rates_json(*result));
  }
  CHECK(documents[0] == documents[1]);
  const auto document = nlohmann::json::parse(documents[0]);
  CHECK(document["method"] == "importance");
  const auto& trace = document["traces"][0];
  CHECK(trace["end"] == "estimated");
  CHECK(trace["any"]["lower"] <= trace["any"]["rate"]);
  CHECK(trace["any"]["rate"] <= trace["any"]["upper"]);
  CHECK(trace["any"]["uniform"] > 500);
}

TEST_CASE(
    "rare rates: p is that of the scenario's law, given its conditions, and the report says "
    "which") {
  // Triangular over 1 to 2 with its mode at 1: a start lies beyond 1.9 with probability 0.01. The
  // condition refuses the lower half, three in four starts: 0.04 of those that are left.
  for (const bool conditioned : {false, true}) {
    RareBench bench(std::string("sampling: {variables: {box.x: {triangular: [1, 1, 2]}}") +
                    (conditioned ? ", require: [\"box.x > 1.5\"]}\n" : "}\n"));
    bench.script.drops = box_far;
    const auto result = bench.estimate();
    REQUIRE(result.has_value());
    const auto& estimate = result->traces[0].estimate;
    const double p = conditioned ? 0.04 : 0.01;
    CHECK(estimate.lower <= p);
    CHECK(estimate.upper >= p);
    CHECK(estimate.lower > p / 5);
    CHECK(estimate.upper < p * 5);
    CHECK(report_says(rates_text(*result), "starts: box.x triangular"));
    const auto document = nlohmann::json::parse(rates_json(*result));
    const auto law = document["traces"][0]["law"].get<std::string>();
    CHECK(report_says(law, "box.x triangular over 1 to 2"));
    CHECK(report_says(law, "given box.x > 1.5") == conditioned);
  }
}

TEST_CASE("rare rates: no discrepancy is a bound and no estimate; splitting needs a margin") {
  RareBench bench;
  bench.script.drops = [](const State&) { return false; };
  const auto none = bench.estimate();
  REQUIRE(none.has_value());
  CHECK_FALSE(none->is_answered());
  CHECK(none->traces[0].estimate.end == RareEventEnd::kUnreached);
  CHECK(none->traces[0].estimate.upper < 0.003);  // 3.1 of 1500 runs or more
  CHECK(report_says(rates_text(*none), "not resolved: none of the "));
  CHECK(nlohmann::json::parse(rates_json(*none))["traces"][0]["any"]["rate"].is_null());
  bench.method = RareEventMethod::kSplitting;
  bench.rates.runs = 4000;
  const auto split = bench.estimate();
  REQUIRE(split.has_value());
  CHECK_FALSE(split->is_answered());
  CHECK_FALSE(nlohmann::json::parse(rates_json(*split))["traces"][0].contains("any"));
}

TEST_CASE("rare rates: one that is lost where it should fail widens the interval") {
  RareBench bench;
  bench.script.seeds = false;
  bench.scenario.limits.max_lost_in_a_row = 1000;
  bench.script.loses = [](const State& start) { return number(start, "box.x") > 1.99; };
  const auto result = bench.estimate();
  REQUIRE(result.has_value());
  const auto& estimate = result->traces[0].estimate;
  REQUIRE(estimate.lost > 0);
  CHECK(estimate.lower < 0.01);
  CHECK(estimate.upper > 0.02);
}

}  // namespace
}  // namespace parallax::harness::test
