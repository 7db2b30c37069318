// Models that leave the outcome of a trace's events open, or the state in which they start.

#include "harness/campaign/campaign.h"
#include "harness/report/report.h"
#include "tests/harness/campaign/two_regions.h"

namespace parallax::harness::test {
namespace {

using LastState = std::map<std::string, bool>;

bool box_left(const LastState& state) { return state.at("BoxIn(r2)"); }

bool says(const TraceResult& trace, const std::string& part) {
  for (const auto& caveat : trace.caveats) {
    if (caveat.find(part) != std::string::npos) return true;
  }
  return false;
}

TEST_CASE("an end state that the model admits is clean, is counted, and is no regression row") {
  Bench bench;
  bench.script.drops = box_far;
  bench.openness.outcomes = true;
  bench.openness.admits = box_left;
  std::int64_t dropped = 0;
  for (std::int64_t sample = 1; sample <= 90; ++sample) {
    if (box_far(drawn_start(bench, 1, sample))) ++dropped;
  }
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(result->verdict == CampaignVerdict::kNoDiscrepancy);
  const auto& trace = result->traces[0];
  CHECK(trace.clean == 90);
  CHECK(dropped > 0);
  CHECK(trace.admitted == dropped);
  CHECK(trace.strayed == 0);
  CHECK_FALSE(trace.paper_stopped_at.has_value());
  CHECK(says(trace,
             "the model leaves the outcome of these events open; states count as predicted if the "
             "model admits them"));
  CHECK(campaign_text(*result, {}).find("not evaluated") != std::string::npos);
}

TEST_CASE("the model is asked about what is compared: every state, or the last one") {
  std::vector<std::size_t> asked, wanted;
  Bench bench;
  SUBCASE("every state") { wanted = {5, 5, 5, 5, 5}; }
  SUBCASE("the last one") {
    bench.scenario.compare = Comparison::kFinal;
    wanted = {0, 0, 0, 0, 5};
  }
  SUBCASE("the last one, by the paper's rule") {
    bench.scenario.criterion.kind = CriterionKind::kPaper;
    wanted = {0, 0, 0, 0, 5};
  }
  bench.script.drops = [](const State&) { return true; };
  bench.openness.outcomes = true;
  bench.openness.asked = &asked;
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(result->verdict == CampaignVerdict::kDiscrepancy);
  CHECK(asked == wanted);
}

TEST_CASE("an end state that the model does not admit is a discrepancy") {
  Bench bench;
  bench.script.drops = box_far;
  bench.openness.outcomes = true;
  int asked = 0;
  bench.openness.admits = [&](const LastState& state) {
    ++asked;
    CHECK(state == LastState{{"BoxIn(r1)", false},
                             {"BoxIn(r2)", true},
                             {"Holding()", false},
                             {"RobotIn(r1)", true},
                             {"RobotIn(r2)", false}});
    return false;
  };
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(asked == 1);
  CHECK(result->verdict == CampaignVerdict::kDiscrepancy);
}

TEST_CASE("a model that leaves nothing open is not asked") {
  Bench bench;
  bench.script.drops = box_far;
  bench.openness.admits = [](const LastState&) {
    FAIL("asked");
    return true;
  };
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(result->verdict == CampaignVerdict::kDiscrepancy);
  CHECK_FALSE(says(result->traces[0], "leaves the outcome"));
}

TEST_CASE("the model is not asked about fluents that are not compared") {
  std::string text = kScenarioText;
  const std::string mapped = "RobotIn(region): {inside: region, body: robot}";
  text.replace(text.find(mapped), mapped.size(), "RobotIn(region): ignored");
  Bench bench(text + "sampling: {variables: {robot.x: [0, 1]}}\n");
  bench.script.drops = box_far;
  bench.openness.outcomes = true;
  bench.openness.admits = [](const LastState& state) {
    CHECK(state.size() == 3);
    CHECK_FALSE(state.contains("RobotIn(r1)"));
    return true;
  };
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(result->traces[0].admitted > 0);
  REQUIRE(result->compared.size() == 3);
  CHECK(result->compared[2].fluent == "RobotIn(..)");
  CHECK(result->compared[2].how == ComparedFluents::How::kIgnored);
  CHECK(result->compared[2].why.empty());
}

TEST_CASE("an answer during which the run was stopped does not count") {
  Bench bench;
  std::atomic<bool> stop = false;
  bench.options.stop = &stop;
  bench.script.drops = box_far;
  bench.openness.outcomes = true;
  bench.openness.admits = [&](const LastState&) {
    stop = true;
    return false;
  };
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(result->interrupted);
  CHECK(result->discrepancies.empty());
  CHECK(result->verdict == CampaignVerdict::kInconclusive);
}

TEST_CASE("the paper's criterion does not stop for runs with several end states") {
  Bench bench(std::string(kScenarioText) + "criterion: {kind: paper, intercept: free}\n");
  bench.scenario.limits.max_runs = 30;
  bench.script.drops = [](const State& start) { return number(start, "box.x") > 1.5; };
  bench.openness.outcomes = true;
  bench.openness.admits = box_left;
  // The rule must not be satisfied before the first such run.
  bench.script.invalid = [&](const State& start) { return !bench.script.drops(start); };
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(result->traces[0].admitted == 30);
  CHECK(result->verdict == CampaignVerdict::kInconclusive);
}

}  // namespace
}  // namespace parallax::harness::test
