#include "harness/campaign/campaign.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "harness/report/report.h"
#include "tests/harness/campaign/two_regions.h"

namespace parallax::harness::test {
namespace {

/// The first sample whose start satisfies the predicate, by drawing alone.
std::int64_t first_sample(const Bench& bench, std::int64_t trace, const Script::OfStart& is) {
  for (std::int64_t sample = 1; sample < 1000; ++sample) {
    if (is(drawn_start(bench, trace, sample))) return sample;
  }
  return 0;
}

TEST_CASE("a world that keeps to the model is clean after the runs that the criterion needs") {
  Bench bench;
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(result->verdict == CampaignVerdict::kNoDiscrepancy);
  CHECK(result->exploration == "all traces explored");
  REQUIRE(result->traces.size() == 1);
  const auto& trace = result->traces[0];
  CHECK(trace.simulations == 90);  // ceil(ln 0.01 / ln 0.95)
  CHECK(trace.clean == 90);
  CHECK(std::abs(trace.certified_epsilon - 0.049881) < 1e-6);
  CHECK(trace.certified_level == 0.99);
  CHECK(exit_code(*result) == 0);
  CHECK(std::count(trace.claim.begin(), trace.claim.end(), '\n') == 0);
}

TEST_CASE("the first start that parts from the model ends the campaign, repeated bit for bit") {
  Bench bench;
  bench.script.drops = box_far;
  bench.traces = 3;
  const auto expected = first_sample(bench, 1, box_far);
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(result->verdict == CampaignVerdict::kDiscrepancy);
  CHECK(result->exploration == "stopped");
  CHECK(result->traces.size() == 1);
  CHECK(result->simulations == expected);
  REQUIRE(result->discrepancies.size() == 1);
  const auto& found = result->discrepancies[0];
  CHECK(found.sample == expected);
  CHECK(found.confirmation == RepeatResult::kBitEqual);
  CHECK(found.first_divergence == 2);
  REQUIRE(found.fluents.size() == 2);
  CHECK(found.fluents[0].fluent == "BoxIn(r1)");
  CHECK(found.fluents[0].predicted);
  CHECK_FALSE(found.fluents[0].observed);
  CHECK(found.fluents[1].fluent == "BoxIn(r2)");
  CHECK(found.record.outcomes[1].status == SimStatus::kFailed);
  CHECK(found.record.outcomes.size() == 4);  // a failed action does not end the sequence
  CHECK(found.record.initial == drawn_start(bench, 1, expected));
  CHECK(exit_code(*result) == 1);
}

TEST_CASE("keep-going asks for the next trace after a discrepancy") {
  Bench bench;
  bench.script.drops = box_far;
  bench.traces = 3;
  bench.options.keep_going = true;
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(result->exploration == "all traces explored");
  REQUIRE(result->discrepancies.size() == 3);
  for (std::int64_t trace = 1; trace <= 3; ++trace) {
    const auto& found = result->discrepancies[static_cast<std::size_t>(trace - 1)];
    CHECK(found.trace == trace);
    CHECK(found.sample == first_sample(bench, trace, box_far));
  }
}

TEST_CASE("a run that leaves the trace on the way and ends as predicted is a discrepancy") {
  Bench bench;
  bench.script.wobbles = box_far;
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(result->verdict == CampaignVerdict::kDiscrepancy);
  CHECK(exit_code(*result) == 1);
  REQUIRE(result->discrepancies.size() == 1);
  const auto& found = result->discrepancies[0];
  CHECK(found.kind == DiscrepancyKind::kTransient);
  CHECK(found.sample == first_sample(bench, 1, box_far));
  CHECK(found.first_divergence == 2);
  REQUIRE(found.first.size() == 2);
  CHECK(found.first[0].fluent == "RobotIn(r1)");
  CHECK(found.fluents.empty());
  CHECK(found.cause.text == "PickUp(): RobotIn(r1)");
  const auto text = campaign_text(*result, {});
  CHECK(text.find("at timepoint 2, after PickUp() (fetch.lisp:3): RobotIn(r1) is true instead of "
                  "false") != std::string::npos);
  CHECK(text.find("it ends as predicted") != std::string::npos);
  CHECK(text.find("RobotIn(r1)  2          false      true\n") != std::string::npos);
  const auto json = nlohmann::json::parse(campaign_json(*result, false));
  CHECK(json.at("compare") == "every-step");
  CHECK(json.at("discrepancies").at(0).at("kind") == "transient");
}

TEST_CASE("where a fluent is compared at rest only, what it does on the way is its own affair") {
  std::string text = kScenarioText;
  const std::string mapped = "RobotIn(region): {inside: region, body: robot}";
  text.replace(text.find(mapped), mapped.size(),
               "RobotIn(region): {inside: region, body: robot, compare: final}");
  Bench bench(text);
  bench.script.wobbles = [](const State&) { return true; };
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(result->verdict == CampaignVerdict::kNoDiscrepancy);
  CHECK(result->traces[0].clean == 90);
  CHECK(result->traces[0].strayed == 0);
  CHECK(campaign_text(*result, {}).find("  only the end RobotIn(..)\n") != std::string::npos);
}

TEST_CASE("where final states are compared such a run is clean, with a note") {
  Bench bench;
  bench.scenario.compare = Comparison::kFinal;
  bench.script.wobbles = box_far;
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(result->verdict == CampaignVerdict::kNoDiscrepancy);
  CHECK(result->traces[0].strayed > 0);
  const auto& caveats = result->traces[0].caveats;
  CHECK(std::any_of(caveats.begin(), caveats.end(), [](const std::string& text) {
    return text.find("left the trace on the way") != std::string::npos;
  }));
}

TEST_CASE("a discrepancy that does not repeat is reported as such") {
  Bench bench;
  bench.script.drops = box_far;
  bench.script.deterministic = false;
  const auto result = bench.run();
  REQUIRE(result.has_value());
  REQUIRE(result->discrepancies.size() == 1);
  CHECK(result->discrepancies[0].confirmation == RepeatResult::kDiffers);
  CHECK(campaign_text(*result, {}).find("not deterministic") != std::string::npos);
}

TEST_CASE("the run limit leaves the trace and the campaign inconclusive, and goes on") {
  Bench bench;
  bench.scenario.limits.max_runs = 20;
  bench.traces = 2;
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(result->verdict == CampaignVerdict::kInconclusive);
  REQUIRE(result->traces.size() == 2);
  CHECK(result->traces[1].simulations == 20);
  CHECK(exit_code(*result) == 4);
}

TEST_CASE(
    "a run limit that the criterion can never meet is warned of, at its place if it has one") {
  Bench bench(std::string(kScenarioText) + "limits: {max_runs: 20}\n");
  std::size_t line = 13;
  SUBCASE("from the scenario") {}
  SUBCASE("from elsewhere") { bench.scenario.limits.max_runs = 89, line = 1; }
  SUBCASE("none") { bench.scenario.limits.max_runs = 0, line = 0; }
  SUBCASE("high enough") { bench.scenario.limits.max_runs = 90, line = 0; }
  const auto result = bench.run();
  REQUIRE(result.has_value());
  if (line == 0) {
    CHECK(codes(bench.sink).empty());
    CHECK(result->verdict == CampaignVerdict::kNoDiscrepancy);
    return;
  }
  CHECK(result->verdict == CampaignVerdict::kInconclusive);
  REQUIRE(codes(bench.sink) == std::vector<std::string>{"W7009"});
  const auto diagnostic = bench.sink.sorted()[0];
  CHECK(diagnostic.message.ends_with("the criterion needs 90 runs"));
  CHECK(bench.files[diagnostic.range->file].position(diagnostic.range->begin).line == line);
}

TEST_CASE("without a run limit there is room for what the criterion asks for") {
  Bench bench(std::string(kScenarioText) + "criterion: {kind: clean-runs, epsilon: 0.01}\n");
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(result->simulations == 459);
  CHECK(result->verdict == CampaignVerdict::kNoDiscrepancy);
}

TEST_CASE("a run that was lost at first and observed then is counted and recorded as retried") {
  Bench bench;
  const auto start = drawn_start(bench, 1, 5);
  std::atomic<int> losses = 0;
  bench.script.loses = [&](const State& s) { return s == start && losses++ == 0; };
  const auto result = bench.run();
  REQUIRE(result.has_value());
  const auto& trace = result->traces[0];
  CHECK(trace.lost == 0);
  CHECK(trace.retried == 1);
  CHECK(trace.clean == 90);
  CHECK(std::any_of(trace.caveats.begin(), trace.caveats.end(), [](const std::string& text) {
    return text.find("1 run was lost at first") == 0;
  }));
  const auto journal = slurp(bench.journal());
  CHECK(journal.find("\"retries\":1") > journal.find("\"sample\":5"));
  CHECK(journal.find("\"retries\":1") < journal.find("\"sample\":6"));
}

TEST_CASE("the result says where starts were drawn from and where a discrepancy ended") {
  Bench bench;
  bench.script.drops = box_far;
  const auto result = bench.run();
  REQUIRE(result.has_value());
  const auto& trace = result->traces[0];
  CHECK(trace.trace->holds(0) == runtime::Names{"BoxIn(r2)", "RobotIn(r1)"});
  REQUIRE(trace.start_region.size() == 2);
  CHECK(trace.start_region[0].variable == "box.x");
  CHECK(trace.start_region[0].interval.lower == 1.0);
  CHECK(trace.start_region[0].interval.upper == 2.0);
  const auto& found = result->discrepancies[0];
  CHECK(found.end ==
        State{{"box.held", false}, {"box.x", found.record.initial.at("box.x")}, {"robot.x", 0.5}});
}

TEST_CASE("the paper's criterion tells that its level is no probability, and waits for lost runs") {
  Bench bench(std::string(kScenarioText) + "criterion: {kind: paper, preset: paper-repaired}\n");
  SUBCASE("none lost") {
    const auto result = bench.run();
    REQUIRE(result.has_value());
    CHECK(result->verdict == CampaignVerdict::kNoDiscrepancy);
    const auto& caveats = result->traces[0].caveats;
    CHECK(std::any_of(caveats.begin(), caveats.end(), [](const std::string& text) {
      return text.find("its level is not the probability of a false stop") != std::string::npos;
    }));
  }
  SUBCASE("one lost") {
    const auto lost = drawn_start(bench, 1, 1);
    bench.script.loses = [&](const State& start) { return start == lost; };
    const auto result = bench.run();
    REQUIRE(result.has_value());
    CHECK(result->verdict == CampaignVerdict::kInconclusive);
    CHECK(result->simulations == 300);
  }
}

TEST_CASE("a search for traces that was stopped leaves the campaign open") {
  for (const int traces : {0, 1}) {
    CAPTURE(traces);
    Bench bench;
    bench.traces = traces;
    bench.openness.is_stopped = true;
    const auto result = bench.run();
    REQUIRE(result.has_value());
    CHECK(result->verdict == CampaignVerdict::kInconclusive);
    CHECK(result->exploration == "stopped");
    CHECK(result->interrupted);
    CHECK(exit_code(*result) == 4);
  }
}

TEST_CASE("an end state of which nothing is known is no discrepancy") {
  Bench bench;
  bench.script.drops = box_far;
  bench.openness = {.outcomes = true, .is_stopped = true};
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(result->verdict == CampaignVerdict::kInconclusive);
  CHECK(result->discrepancies.empty());
}

TEST_CASE("the trace limit leaves the campaign inconclusive only if there was a further trace") {
  Bench bench;
  bench.traces = 2;
  SUBCASE("one more") {
    bench.scenario.limits.max_traces = 1;
    const auto result = bench.run();
    REQUIRE(result.has_value());
    CHECK(result->verdict == CampaignVerdict::kInconclusive);
    CHECK(result->exploration == "stopped");
    CHECK(result->traces.size() == 1);
  }
  SUBCASE("none more") {
    bench.scenario.limits.max_traces = 2;
    const auto result = bench.run();
    REQUIRE(result.has_value());
    CHECK(result->verdict == CampaignVerdict::kNoDiscrepancy);
  }
}

TEST_CASE("without a trace nothing is compared, and the exit code says so") {
  Bench bench;
  bench.traces = 0;
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(result->simulations == 0);
  CHECK(result->verdict == CampaignVerdict::kInconclusive);
  CHECK(exit_code(*result) == 4);
}

TEST_CASE("invalid starts are drawn again and counted, and are no simulations") {
  Bench bench;
  bench.script.invalid = [](const State& start) { return number(start, "box.x") < 1.3; };
  std::int64_t rejected = 0;
  for (std::int64_t sample = 1; sample <= 90; ++sample) {
    std::int64_t attempt = 0;
    while (bench.script.invalid(drawn_start(bench, 1, sample, attempt))) ++attempt;
    rejected += attempt;
  }
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(result->traces[0].simulations == 90);
  CHECK(rejected > 0);
  CHECK(result->traces[0].rejected == rejected);
  CHECK(result->verdict == CampaignVerdict::kNoDiscrepancy);
}

TEST_CASE("starts that are always invalid end the campaign with the colliding pair") {
  Bench bench;
  bench.script.invalid = [](const State&) { return true; };
  bench.scenario.limits.max_rejected_starts = 7;
  CHECK_FALSE(bench.run().has_value());
  REQUIRE(codes(bench.sink) == std::vector<std::string>{"E7105"});
  const auto message = bench.sink.sorted()[0].message;
  CHECK(message.find("7 starts in a row") != std::string::npos);
  CHECK(message.find("box and robot overlap by 3 mm") != std::string::npos);
  CHECK(bench.sink.exit_code() == 3);
}

TEST_CASE("an initial observation that does not map back is an internal error") {
  Bench bench;
  // As if it were the built-in one, with its arguments.
  pretend_built_in(bench.scenario);
  for (auto& action : bench.scenario.actions) {
    if (action.controller != "picking-up") action.arguments["target.x"] = 0.5;
  }
  bench.script.start_shift_m = 1.0;
  CHECK_FALSE(bench.run().has_value());
  CHECK(codes(bench.sink) == std::vector<std::string>{"E7106"});
  CHECK(bench.sink.exit_code() == 5);
}

TEST_CASE("an external simulator that does not start where it was put is at fault itself") {
  Bench bench;
  bench.scenario.simulator.command = {"some-simulator"};
  bench.script.start_shift_m = 1.0;
  CHECK_FALSE(bench.run().has_value());
  CHECK(codes(bench.sink) == std::vector<std::string>{"E7112"});
  CHECK(bench.sink.exit_code() == 3);
}

TEST_CASE("what the simulator refuses or does not report is the scenario's error") {
  Bench bench;
  std::string place, what;
  SUBCASE("an action") {
    bench.script.refuses = "placing", place = "Place()";
    what = "refused `Place()` in simulation 1 of trace 1: no such action";
  }
  SUBCASE("a variable") {
    bench.script.hides_box = true, place = "BoxIn(region)";
    what = "does not show what is compared in simulation 1 of trace 1: its observations lack";
  }
  CHECK_FALSE(bench.run().has_value());
  REQUIRE(codes(bench.sink) == std::vector<std::string>{"E7109"});
  const auto diagnostic = first_error(bench.sink);
  CHECK(diagnostic.message.find(what) != std::string::npos);
  REQUIRE(diagnostic.range.has_value());
  CHECK(bench.files.text(*diagnostic.range) == place);
  CHECK(bench.sink.exit_code() == 3);
}

TEST_CASE("a simulator that does not start leaves the question open") {
  Bench bench;
  bench.script.start_failure = "cannot start `scripted`: No such file or directory";
  CHECK_FALSE(bench.run().has_value());
  CHECK(codes(bench.sink) == std::vector<std::string>{"E7108"});
  CHECK(bench.sink.exit_code() == 4);
}

TEST_CASE("a lost run gets the same start and seed once more, then counts as a failure") {
  Bench bench;
  const auto lost_start = drawn_start(bench, 1, 5);
  bench.script.loses = [&](const State& start) { return start == lost_start; };
  std::atomic<int> resets = 0;
  bench.script.resets = &resets;
  const auto result = bench.run();
  REQUIRE(result.has_value());
  const auto& trace = result->traces[0];
  CHECK(trace.lost == 1);
  CHECK(resets == trace.simulations + 1 + 2);  // one retry, and the first clean one twice more
  CHECK(trace.simulations == trace.clean + 1);
  CHECK(trace.simulations > 90);  // a failure in the bound asks for more runs
  CHECK(trace.certified_epsilon <= 0.05);
  CHECK(result->verdict == CampaignVerdict::kNoDiscrepancy);
}

TEST_CASE("runs lost in a row end the campaign as inconclusive, and it can be continued") {
  Bench bench;
  bool broken = true;
  bench.script.loses = [&](const State& start) { return broken && box_far(start); };
  const auto at = first_sample(bench, 1, box_far);
  bench.scenario.limits.max_lost_in_a_row = 1;
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(result->verdict == CampaignVerdict::kInconclusive);
  CHECK(result->simulations == at);
  CHECK(codes(bench.sink) == std::vector<std::string>{"E7107"});
  CHECK(bench.sink.exit_code() == 4);
  broken = false;
  bench.options.resume = true;
  const auto continued = bench.run();
  REQUIRE(continued.has_value());
  CHECK(continued->verdict == CampaignVerdict::kNoDiscrepancy);
  CHECK(continued->timing.runs_made == 90 - (at - 1));
}

TEST_CASE("the report does not depend on the number of jobs, nor on how long failing runs take") {
  struct Case {
    const char* name;
    bool keep_going;
    double drops_above_m;
  };
  for (const Case& kind :
       {Case{"stops", false, 1.95}, Case{"goes on", true, 1.95}, Case{"clean", true, 2.5}}) {
    CAPTURE(kind.name);
    std::vector<std::string> journals, texts, documents;
    for (const std::int64_t jobs : {1, 2, 8}) {
      Bench bench;
      bench.script.drops = [&](const State& s) { return number(s, "box.x") > kind.drops_above_m; };
      bench.script.drop_delay = std::chrono::milliseconds(60);
      bench.options.keep_going = kind.keep_going;
      bench.options.jobs = jobs;
      bench.traces = 3;
      auto result = bench.run();
      REQUIRE(result.has_value());
      result->replay_folder = "run";  // a temporary folder, another one each time
      REQUIRE(write_report(*result, bench.options.run_dir, bench.sink).has_value());
      journals.push_back(slurp(bench.journal()));
      texts.push_back(slurp(bench.options.run_dir / "report.txt"));
      documents.push_back(slurp(bench.options.run_dir / "report.json"));
    }
    CHECK(journals[0] == journals[1]);
    CHECK(journals[0] == journals[2]);
    CHECK(texts[0] == texts[1]);
    CHECK(texts[0] == texts[2]);
    CHECK(documents[0] == documents[1]);
    CHECK(documents[0] == documents[2]);
  }
}

TEST_CASE("the seed decides the starts") {
  Bench one, two;
  two.options.seed = 2;
  one.scenario.limits.max_runs = two.scenario.limits.max_runs = 3;
  REQUIRE(one.run().has_value());
  REQUIRE(two.run().has_value());
  CHECK(slurp(one.journal()) != slurp(two.journal()));
  CHECK(drawn_start(one, 1, 1) != drawn_start(two, 1, 1));
  CHECK(drawn_start(one, 1, 1) != drawn_start(one, 2, 1));
}

TEST_CASE("progress counts the samples that were consumed") {
  Bench bench;
  std::vector<std::int64_t> done;
  bench.options.progress = [&](const CampaignProgress& p) {
    CHECK(p.needed == 90);
    done.push_back(p.done);
  };
  bench.options.jobs = 4;
  REQUIRE(bench.run().has_value());
  REQUIRE(done.size() == 91);
  for (std::size_t i = 0; i < done.size(); ++i) CHECK(done[i] == static_cast<std::int64_t>(i));
}

TEST_CASE("a controller of the built-in robot must be given what it needs") {
  Bench bench;
  pretend_built_in(bench.scenario);
  CHECK_FALSE(bench.run().has_value());
  REQUIRE(codes(bench.sink) == std::vector<std::string>{"E5122"});
  CHECK(bench.sink.sorted()[0].message == "`Place()` gives the controller `placing` no `target.x`");
}

TEST_CASE("a start that the simulator cannot be put into is refused before anything is run") {
  Bench bench(std::string(kScenarioText) + "sampling: {variables: {box.held: 0}}\n");
  CHECK_FALSE(bench.run().has_value());
  CHECK(codes(bench.sink) == std::vector<std::string>{"E5116"});
  CHECK_FALSE(std::filesystem::exists(bench.journal()));
}

TEST_CASE("what a worker throws outside of a simulation reaches the caller") {
  Bench bench;
  bench.options.jobs = 2;
  bench.script.on_info = [] { throw std::runtime_error("thrown in a worker"); };
  CHECK_THROWS_AS(static_cast<void>(bench.run()), std::runtime_error);
}

}  // namespace
}  // namespace parallax::harness::test
