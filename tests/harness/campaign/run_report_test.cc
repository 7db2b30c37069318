// What a run was judged to be comes back from its report.

#include "harness/report/run_report.h"

#include <cmath>
#include <limits>

#include "harness/report/report.h"
#include "tests/harness/campaign/two_regions.h"

namespace parallax::harness::test {
namespace {

void check_fluents(const std::vector<DivergingFluent>& read,
                   const std::vector<DivergingFluent>& judged) {
  REQUIRE(read.size() == judged.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    CHECK(read[i].fluent == judged[i].fluent);
    CHECK(read[i].timepoint == judged[i].timepoint);
    CHECK(read[i].predicted == judged[i].predicted);
    CHECK(read[i].observed == judged[i].observed);
  }
}

void check_path(const SampleRecord& read, const SampleRecord& judged) {
  REQUIRE(read.path.has_value() == judged.path.has_value());
  if (!read.path) return;
  CHECK(read.path->start == judged.path->start);
  CHECK(read.path->end == judged.path->end);
  REQUIRE(read.path->steps.size() == judged.outcomes.size());
  for (std::size_t i = 0; i < read.path->steps.size(); ++i) {
    const auto &one = read.path->steps[i], &other = judged.path->steps[i];
    CHECK(one.event == other.event);
    CHECK(one.source == other.source);
    CHECK(one.succeeded == other.succeeded);
    CHECK(one.object == other.object);
    CHECK(one.condition == other.condition);
  }
}

void check_discrepancy(const ReportedDiscrepancy& reported, const Discrepancy& judged) {
  const auto& read = reported.found;
  CHECK(reported.is_whole);
  CHECK(reported.has_cause);
  CHECK(read.kind == judged.kind);
  CHECK(read.trace == judged.trace);
  CHECK(read.sample == judged.sample);
  CHECK(read.seed == judged.seed);
  CHECK(read.first_divergence == judged.first_divergence);
  check_fluents(read.first, judged.first);
  check_fluents(read.fluents, judged.fluents);
  CHECK(read.cause.text == judged.cause.text);
  CHECK(read.cause.reason == judged.cause.reason);
  CHECK(read.cause.event == judged.cause.event);
  CHECK(read.cause.fluents == judged.cause.fluents);
  CHECK(read.confirmation == judged.confirmation);
  CHECK(read.record.initial == judged.record.initial);
  CHECK(read.end == judged.end);
  REQUIRE(read.record.outcomes.size() == judged.record.outcomes.size());
  for (std::size_t i = 0; i < read.record.outcomes.size(); ++i) {
    CHECK(read.record.outcomes[i].status == judged.record.outcomes[i].status);
    CHECK(read.record.outcomes[i].reason == judged.record.outcomes[i].reason);
    CHECK(read.record.outcomes[i].sim_time_s == judged.record.outcomes[i].sim_time_s);
  }
  REQUIRE(read.path.has_value() == judged.path.has_value());
  if (read.path) {
    CHECK(read.path->event == judged.path->event);
    CHECK(read.path->impossible == judged.path->impossible);
    CHECK(read.path->outcome == judged.path->outcome);
    CHECK(read.path->together == judged.path->together);
  }
  check_path(read.record, judged.record);
}

void check_round_trip(const CampaignResult& result) {
  const auto report = read_run_report(campaign_json(result, true));
  REQUIRE(report);
  CHECK(report->status == "ok");
  CHECK(report->scenario == result.scenario);
  CHECK(report->seed == result.seed);
  CHECK(report->tool_version == result.tool_version);
  CHECK(report->verdict == to_string(result.verdict));
  CHECK(report->iterations == std::ssize(result.traces));
  CHECK(report->simulations == result.simulations);
  CHECK(report->exploration == result.exploration);
  CHECK(report->execution == to_string(result.execution));
  CHECK(report->comparison == to_string(result.comparison));
  CHECK(report->simulator_name == result.simulator.name);
  CHECK(report->simulator_version == result.simulator.version);
  REQUIRE(report->criterion_spec);
  CHECK(report->criterion_spec->kind == result.criterion.kind);
  CHECK(report->criterion_spec->confidence_level == result.criterion.confidence_level);
  CHECK(report->criterion_spec->epsilon == result.criterion.epsilon);
  CHECK(report->criterion_spec->paper.preset == result.criterion.paper.preset);
  CHECK(report->family.has_value() == result.spending.has_value());
  if (report->family) CHECK(report->family->claim == result.claim);
  CHECK(report->coverage.size() == result.coverage.size());
  CHECK(report->opinion.has_value() == (result.second_opinion != nullptr));
  CHECK(report->interrupted == result.interrupted);
  REQUIRE(report->traces);
  REQUIRE(report->traces->size() == result.traces.size());
  for (std::size_t i = 0; i < result.traces.size(); ++i) {
    const auto& read = report->traces->at(i);
    const auto& judged = result.traces[i];
    const auto& trace = *judged.trace;
    const auto holds = trace.holds(0);
    CHECK(read.initial_state == std::vector<std::string>(holds.begin(), holds.end()));
    CHECK(read.simulations == judged.simulations);
    CHECK(read.clean == judged.clean);
    CHECK(read.confidence == judged.certified_level);
    CHECK(read.epsilon == judged.certified_epsilon);
    CHECK(read.claim == judged.claim);
    CHECK(read.caveats == judged.caveats);
    CHECK(read.not_covered == judged.not_covered);
    CHECK(read.lost == judged.lost);
    CHECK(read.error_share == judged.error_share);
    CHECK(read.paper_stopped_at == judged.paper_stopped_at);
    CHECK(read.paper_variant == judged.paper_variant);
    CHECK(read.number == trace.number);
    CHECK(read.verdict == to_string(result.traces[i].verdict));
    REQUIRE(read.events.size() == trace.event_count());
    REQUIRE(read.sources.size() == trace.event_count());
    for (std::size_t t = 0; t < read.events.size(); ++t) {
      CHECK(read.events[t] == trace.event(t));
      CHECK(read.sources[t] == trace.plan[t].source);
    }
  }
  REQUIRE(report->discrepancies);
  REQUIRE(report->discrepancies->size() == result.discrepancies.size());
  for (std::size_t i = 0; i < result.discrepancies.size(); ++i) {
    check_discrepancy(report->discrepancies->at(i), result.discrepancies[i]);
    const auto standing = standing_of(result, result.discrepancies[i]);
    CHECK(report->discrepancies->at(i).standing.is == standing.is);
    CHECK(report->discrepancies->at(i).standing.words == standing.words);
  }
}

TEST_CASE("a report gives back what was judged: clean, lasting, transient, of several traces") {
  Bench bench;
  bench.traces = 3;
  bench.options.keep_going = true;
  SUBCASE("clean") {}
  SUBCASE("actions that fail") { bench.script.drops = box_far; }
  SUBCASE("what differs on the way") { bench.script.wobbles = box_far; }
  const auto result = bench.run();
  REQUIRE(result.has_value());
  check_round_trip(*result);
}

TEST_CASE("a report gives back an executed plan, and every way to confirm and to end") {
  Bench bench;
  bench.script.drops = box_far;
  auto result = bench.run();
  REQUIRE(result.has_value());
  auto& found = result->discrepancies.at(0);
  result->execution = Execution::kClosedLoop;
  found.path = PathDivergence{1, true, false, true};
  found.end["box.odd"] = std::string("a \"text\"");
  found.end["box.count"] = std::int64_t{-3};
  auto& path = found.record.path.emplace();
  path.start = 4;
  for (std::size_t i = 0; i < found.record.outcomes.size(); ++i) {
    PathStep step;
    step.event = "Detect(cup)";
    step.source = "fetch.lisp:7";
    step.succeeded = i % 2 == 0;
    step.object = step.succeeded ? "cup1" : "";
    step.condition = step.succeeded ? "" : "perception-object-not-found";
    path.steps.push_back(step);
  }
  for (const auto end : {PathEnd::kDone, PathEnd::kFailed, PathEnd::kPerformLimit,
                         PathEnd::kTimeLimit, PathEnd::kCut}) {
    path.end = end;
    check_round_trip(*result);
  }
  for (const auto how : {RepeatResult::kBitEqual, RepeatResult::kDiffers, RepeatResult::kLost}) {
    found.confirmation = how;
    check_round_trip(*result);
  }
}

TEST_CASE("a number that is not finite comes back as NaN") {
  Bench bench;
  bench.script.drops = box_far;
  auto result = bench.run();
  REQUIRE(result.has_value());
  result->discrepancies.at(0).end["box.x"] = std::numeric_limits<double>::infinity();
  const auto report = read_run_report(campaign_json(*result, false));
  REQUIRE(report);
  const auto& end = report->discrepancies.value().at(0).found.end;
  CHECK(std::isnan(std::get<double>(end.at("box.x"))));
}

TEST_CASE("of a damaged report what is there is read, and entries keep their places") {
  for (const auto* text : {"", "{", "[]", "null", "7"}) CHECK_FALSE(read_run_report(text));
  const auto empty = read_run_report("{}");
  REQUIRE(empty);
  CHECK_FALSE(empty->traces.has_value());
  CHECK_FALSE(empty->discrepancies.has_value());
  CHECK_FALSE(empty->interrupted.has_value());
  CHECK(empty->criterion.empty());
  const auto odd = read_run_report(
      R"x({"verdict": 3, "interrupted": "no", "criterion": {"b": 1, "a": 2}, "simulator": [],)x"
      R"x("traces": [7, {"trace": 2, "events": [1, "E()"]}], "discrepancies": [{}, 7,)x"
      R"x({"trace": 1, "sample": 2, "first_divergence": -1, "first": []},)x"
      R"x({"trace": 1, "sample": 3, "first_divergence": 0, "first": [{"fluent": "F()"}]},)x"
      R"x({"trace": 1, "sample": 4, "first_divergence": 0, "first": [], "cause": {"text": "E(): F()"},)x"
      R"x("start": {"a": [1], "b": true}, "outcomes": [5]}]})x");
  REQUIRE(odd);
  CHECK(odd->verdict.empty());
  CHECK_FALSE(odd->interrupted.has_value());
  CHECK(odd->criterion == R"({"a":2,"b":1})");
  REQUIRE(odd->traces.value().size() == 2);
  CHECK(odd->traces->at(1).events == std::vector<std::string>{"E()"});
  REQUIRE(odd->discrepancies.value().size() == 5);
  for (std::size_t i = 0; i < 4; ++i) CHECK_FALSE(odd->discrepancies->at(i).is_whole);
  const auto& last = odd->discrepancies->at(4);
  CHECK(last.is_whole);
  CHECK_FALSE(last.has_cause);
  CHECK(last.id() == "1.4");
  CHECK(last.found.record.initial == State{{"b", true}});
  CHECK(last.found.record.outcomes.size() == 1);
}

}  // namespace
}  // namespace parallax::harness::test
