// Claims about several traces together, and the runs that they take.

#include "harness/confidence/clean_runs.h"
#include "harness/report/report.h"
#include "tests/harness/campaign/two_regions.h"

namespace parallax::harness::test {
namespace {

std::vector<std::int64_t> runs_of(const CampaignResult& result) {
  std::vector<std::int64_t> out;
  for (const auto& trace : result.traces) out.push_back(trace.simulations);
  return out;
}

bool says(const std::string& text, std::string_view part) {
  CAPTURE(text);
  const bool found = text.find(part) != std::string::npos;
  CHECK(found);
  return found;
}

TEST_CASE("each of several traces takes the runs of one, as all of them have to pass") {
  Bench bench;
  bench.traces = 3;
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(result->verdict == CampaignVerdict::kNoDiscrepancy);
  CHECK(runs_of(*result) == std::vector<std::int64_t>{90, 90, 90});
  for (const auto& trace : result->traces) {
    CHECK(trace.error_share == 1.0);
    CHECK(trace.certified_level == 0.99);
    CHECK(trace.certified_epsilon == doctest::Approx(bound_after(90, 0.99)));
    // For a sentence that would leave others out.
    CHECK(trace.shared.epsilon == doctest::Approx(bound_after(90, 1.0 - 0.01 / 3.0)));
  }
  CHECK(result->claim ==
        "with 99 % confidence, for each of the 3 traces fewer than 5 % of start states drawn "
        "uniformly from its start region give a discrepancy at any step (270 clean runs of 270), "
        "supposing that no run affects another; the solver finds no other trace");
  CHECK(says(campaign_summary(*result, {}), "90 clean runs of each of 3 traces exclude"));
}

TEST_CASE("each trace by itself takes the runs of one, and nothing is said of all") {
  Bench bench;
  bench.traces = 3;
  bench.scenario.criterion.family = Family::kPerTrace;
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(runs_of(*result) == std::vector<std::int64_t>{90, 90, 90});
  CHECK(result->claim.empty());
  CHECK_FALSE(result->spending.has_value());
  CHECK(says(campaign_summary(*result, {}), "each holds for its trace alone"));
}

TEST_CASE("more traces than are looked at ahead spend a series") {
  Bench bench;
  bench.traces = 102;
  bench.scenario.criterion.confidence_level = 0.6;  // few runs, each synced to a disk
  bench.scenario.criterion.epsilon = 0.5;
  const auto result = bench.run();
  REQUIRE(result.has_value());
  REQUIRE(result->traces.size() == 102);
  REQUIRE(result->spending.has_value());
  CHECK_FALSE(result->spending->traces().has_value());
  const auto needed = runs_needed(0.6, 0.5);
  for (const auto& trace : result->traces) {
    CHECK(trace.simulations == needed);
    const double share = result->spending->share(trace.trace->number);
    CHECK(trace.shared.epsilon == doctest::Approx(bound_after(needed, 1.0 - 0.4 * share)));
  }
  CHECK(result->verdict == CampaignVerdict::kNoDiscrepancy);
  CHECK(says(result->claim, "for each of the 102 traces fewer than 50 %"));

  SUBCASE("but not one fewer") {
    Bench fewer;
    fewer.traces = 100;
    fewer.scenario.criterion = bench.scenario.criterion;
    const auto known = fewer.run();
    REQUIRE(known.has_value());
    CHECK(known->spending->traces() == 100);
  }
  SUBCASE("nor where a limit says how many are simulated") {
    Bench limited;
    limited.traces = 102;
    limited.scenario.criterion = bench.scenario.criterion;
    limited.scenario.limits.max_traces = 4;
    const auto four = limited.run();
    REQUIRE(four.has_value());
    CHECK(four->spending->traces() == 4);
    CHECK(four->traces.size() == 4);
    CHECK(says(four->claim, "the model may have other traces"));
  }
}

TEST_CASE("the series costs 100, 127 and 143 runs for the first three traces") {
  const SpendingRule series(std::nullopt);
  CriterionSpec spec;
  std::vector<std::int64_t> runs;
  double sum = 0.0;
  for (std::int64_t k = 1; k <= 3; ++k) {
    spec.share = series.share(k);
    runs.push_back(planned_runs(spec));
  }
  for (std::int64_t k = 1; k <= 100'000; ++k) sum += series.share(k);
  CHECK(runs == std::vector<std::int64_t>{100, 127, 143});
  CHECK(sum < 1.0);
  CHECK(sum > 0.9999);
}

TEST_CASE("a discrepancy that ends the run costs no look ahead, and leaves no sentence") {
  Bench bench;
  bench.traces = 3;
  bench.script.drops = [](const State&) { return true; };
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(result->simulations == 1);
  CHECK_FALSE(result->spending.has_value());
  CHECK(result->claim.empty());
}

TEST_CASE("what ends a run early takes nothing from what is known of its traces") {
  SUBCASE("a discrepancy in the last one") {
    Bench bench;
    bench.traces = 3;
    const auto first = drawn_start(bench, 3, 4);
    bench.script.drops = [&](const State& s) { return s == first; };
    const auto result = bench.run();
    REQUIRE(result.has_value());
    CHECK(result->verdict == CampaignVerdict::kDiscrepancy);
    CHECK(says(result->claim, "; the solver finds no other trace"));
    CHECK(result->exploration == "all traces explored");
  }
  SUBCASE("a discrepancy before the last one, which was found and is not simulated") {
    Bench bench;
    bench.traces = 3;
    const auto first = drawn_start(bench, 2, 4);
    bench.script.drops = [&](const State& s) { return s == first; };
    const auto result = bench.run();
    REQUIRE(result.has_value());
    CHECK(
        says(result->claim, "; 1 of 3 traces was not simulated; the solver finds no other trace"));
    CHECK(result->exploration == "stopped");
  }
}

TEST_CASE("of traces with a discrepancy the sentence says that they are left out") {
  Bench bench;
  bench.traces = 3;
  bench.options.keep_going = true;
  const auto first = drawn_start(bench, 2, 4);
  bench.script.drops = [&](const State& s) { return s == first; };
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(runs_of(*result) == std::vector<std::int64_t>{90, 4, 90});
  CHECK(says(result->claim, "for each of the 2 of 3 traces that gave no discrepancy fewer"));
  CHECK(says(result->claim, "(180 clean runs of 180)"));
  // They were chosen by what runs showed, so each has a third of the error.
  CHECK(says(result->claim, "fewer than 6.15 % of"));
}

TEST_CASE("a lost run costs the confidence of the sentence, as it does that of its trace") {
  Bench bench;
  bench.traces = 2;
  bench.script.seeds = false;
  bench.script.determinism = "none";
  const auto lost = drawn_start(bench, 2, 5);
  bench.script.loses = [&](const State& s) { return s == lost; };
  const auto result = bench.run();
  REQUIRE(result.has_value());
  const auto needed = mixture_runs_needed(1, 0.99, 0.05);
  CHECK(runs_of(*result) == std::vector<std::int64_t>{90, needed});
  CHECK(result->traces[0].certified_level == 0.99);
  CHECK(result->traces[1].certified_level == doctest::Approx(0.98));
  CHECK(says(result->claim, "with 98 % confidence, for each of the 2 traces"));

  SUBCASE("but not with the criterion that survives it") {
    Bench anytime;
    anytime.traces = 2;
    anytime.script = bench.script;
    anytime.scenario.criterion.kind = CriterionKind::kAnytime;
    const auto same = anytime.run();
    REQUIRE(same.has_value());
    CHECK(says(same->claim, "with 99 % confidence, for each of the 2 traces fewer than 5 %"));
  }
}

TEST_CASE("a search that ends early leaves each trace by itself, and says so") {
  Bench bench;
  bench.traces = 2;
  bench.openness.is_stopped = true;
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(runs_of(*result) == std::vector<std::int64_t>{90, 90});
  CHECK(result->claim.empty());
  CHECK(says(campaign_text(*result, {}), "the claim is about this trace by itself"));
}

TEST_CASE("the paper's rule stops when it does, whatever is claimed of all traces") {
  Bench bench;
  bench.traces = 2;
  bench.scenario.criterion.kind = CriterionKind::kPaper;
  bench.scenario.criterion.paper = paper_repaired();
  const auto together = bench.run();
  REQUIRE(together.has_value());
  Bench alone;
  alone.traces = 2;
  alone.scenario.criterion = bench.scenario.criterion;
  alone.scenario.criterion.family = Family::kPerTrace;
  const auto apart = alone.run();
  REQUIRE(apart.has_value());
  CHECK(runs_of(*together) == runs_of(*apart));
  const auto runs = together->traces[0].simulations;
  CHECK(together->traces[0].certified_epsilon == doctest::Approx(bound_after(runs, 0.99)));
  CHECK(apart->traces[0].certified_epsilon == doctest::Approx(bound_after(runs, 0.99)));
}

TEST_CASE("a limit that is too low for each trace is warned of, and the sentence says less") {
  Bench bench;
  bench.traces = 3;
  bench.scenario.limits.max_runs = 80;
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(result->verdict == CampaignVerdict::kInconclusive);
  CHECK(codes(bench.sink) == std::vector<std::string>{std::string(kLowLimit)});
  CHECK(says(result->claim, "for each of the 3 traces fewer than 5.6 %"));
}

TEST_CASE("the same bytes for any number of jobs, and after any interruption") {
  Bench bench;
  bench.traces = 3;
  const auto once = bench.run();
  REQUIRE(once.has_value());
  const auto report = campaign_json(*once, false);
  for (const std::int64_t jobs : {2, 5}) {
    Bench other;
    other.traces = 3;
    other.options.jobs = jobs;
    auto same = other.run();
    REQUIRE(same.has_value());
    same->replay_folder = once->replay_folder;
    CHECK(campaign_json(*same, false) == report);
    CHECK(slurp(other.journal()) == slurp(bench.journal()));
  }
  // Ends of a run: 40 within the first trace; 100 between the runs that it needs alone and with
  // others; 150 behind it.
  for (const int resets : {40, 100, 150}) {
    CAPTURE(resets);
    Bench other;
    other.traces = 3;
    std::atomic<bool> stop = false;
    std::atomic<int> made = 0;
    other.script.resets = &made;
    other.script.on_act = [&] { stop = made >= resets; };
    other.options.stop = &stop;
    const auto part = other.run();
    REQUIRE(part.has_value());
    CHECK(part->interrupted);
    stop = false;
    other.script.on_act = [] {};
    other.options.resume = true;
    auto whole = other.run();
    REQUIRE(whole.has_value());
    whole->replay_folder = once->replay_folder;
    CHECK(campaign_json(*whole, false) == report);
    CHECK(slurp(other.journal()) == slurp(bench.journal()));
  }
}

TEST_CASE("a run is not continued with another family") {
  Bench bench;
  bench.traces = 2;
  REQUIRE(bench.run().has_value());
  bench.options.resume = true;
  bench.scenario.criterion.family = Family::kPerTrace;
  CHECK_FALSE(bench.run().has_value());
  CHECK(says(first_error(bench.sink).message, "family"));
}

}  // namespace
}  // namespace parallax::harness::test
