// The loop that all modes share, driven by hand.

#include "harness/campaign/trial.h"

#include "compiler/base/hash.h"
#include "harness/campaign/journal.h"
#include "tests/harness/campaign/two_regions.h"

namespace parallax::harness::test {
namespace {

/// A bench that was started, and trials of its traces.
struct Trials : Bench {
  explicit Trials(std::int64_t jobs = 1) : trial_options{1, jobs, &stop} {}

  TrialBench& start() {
    feed.emplace(3, openness);
    const auto factory = [this] { return std::make_unique<ScriptedSimulator>(script); };
    bench.emplace(
        scenario, *feed, factory, trial_options, [this](const SampleRecord&) { ++finished; }, sink);
    const auto started = bench->start();
    REQUIRE(started.has_value());
    REQUIRE(*started);
    return *bench;
  }
  Trial prepared() {
    auto trace = feed->next();
    REQUIRE(trace.has_value());
    auto trial = Trial::prepare(*bench, *std::move(*trace));
    REQUIRE(trial.has_value());
    return *std::move(trial);
  }

  std::atomic<bool> stop = false;
  std::atomic<int> finished = 0;
  TrialOptions trial_options;
  std::optional<ListFeed> feed;
  std::optional<TrialBench> bench;
};

TrialSample next_of(Trial& trial) {
  auto sample = trial.next();
  REQUIRE(sample.has_value());
  REQUIRE(sample->has_value());
  return **std::move(sample);
}

TEST_CASE("nobody need be told of finished simulations") {
  Trials bench;
  bench.feed.emplace(1, bench.openness);
  const auto factory = [&] { return std::make_unique<ScriptedSimulator>(bench.script); };
  bench.bench.emplace(bench.scenario, *bench.feed, factory, bench.trial_options,
                      std::function<void(const SampleRecord&)>(), bench.sink);
  REQUIRE(bench.bench->start().has_value());
  auto trial = bench.prepared();
  CHECK(next_of(trial).verdict == SampleVerdict::kAsPredicted);
  trial.end();
}

TEST_CASE("a trial is prepared with the region, the calls and the draws of its trace") {
  Trials bench;
  bench.start();
  const auto trial = bench.prepared();
  REQUIRE(trial.start().dimensions.size() == 2);
  CHECK(trial.start().dimensions[0].variable == "box.x");
  CHECK(trial.start().dimensions[0].interval.lower == 1.0);
  CHECK(trial.start().dimensions[1].variable == "robot.x");
  const auto& plan = trial.plan();
  CHECK(plan.trace->number == 1);
  REQUIRE(plan.calls.size() == 4);
  CHECK(plan.calls[0].controller == "going");
  CHECK(plan.calls[0].arguments == State{{"target.x", 1.25}});
  CHECK(plan.calls[0].time_limit_s == 30.0);
  CHECK(plan.calls[1].arguments == State{{"object", std::string("box")}});
  CHECK(plan.campaign_seed == 1);
  CHECK(plan.trace_key == base::fnv1a64("fetch 1"));
  CHECK(plan.repeats_losses);
  CHECK(trial.next_sample() == 1);
}

TEST_CASE("samples come in the order of their numbers, whatever was submitted and finished") {
  Trials bench(4);
  bench.script.drops = box_far;
  bench.script.drop_delay = std::chrono::milliseconds(30);
  bench.start();
  auto trial = bench.prepared();
  trial.submit_to(20);
  for (std::int64_t number = 1; number <= 30; ++number) {
    CHECK(trial.next_sample() == number);
    const auto sample = next_of(trial);
    CHECK(sample.record.sample == number);
    CHECK(sample.record.initial == drawn_start(bench, 1, number));
    const bool drops = box_far(sample.record.initial);
    CHECK((sample.verdict == SampleVerdict::kDiscrepancy) == drops);
    CHECK((sample.verdict == SampleVerdict::kAsPredicted) == !drops);
    CHECK(sample.judgement.matches(Comparison::kEveryStep) == !drops);
  }
  CHECK(bench.finished == 30);
}

TEST_CASE("another end is held against the model only where the model leaves the end open") {
  Trials bench;
  bench.script.drops = [](const State&) { return true; };
  auto expected = SampleVerdict::kDiscrepancy;
  int asked = 0;
  bench.openness.admits = [&](const std::map<std::string, bool>& last) {
    ++asked;
    CHECK(last.at("BoxIn(r2)"));
    CHECK_FALSE(last.at("Holding()"));
    return true;
  };
  bool open = false;
  SUBCASE("it is open") { open = true, expected = SampleVerdict::kAdmitted; }
  SUBCASE("it is not") {}
  SUBCASE("only the trace counts") { open = true, bench.scenario.match_model = false; }
  bench.openness.outcomes = open;
  bench.start();
  auto trial = bench.prepared();
  CHECK(next_of(trial).verdict == expected);
  CHECK(asked == (expected == SampleVerdict::kAdmitted ? 1 : 0));
}

TEST_CASE("losses in a row are counted across traces, and an observed run ends the row") {
  Trials bench;
  bench.scenario.limits.max_lost_in_a_row = 3;
  bool lost = true;
  bench.script.loses = [&](const State&) { return lost; };
  bench.start();
  auto first = bench.prepared();
  CHECK(next_of(first).verdict == SampleVerdict::kLost);
  CHECK(next_of(first).verdict == SampleVerdict::kLost);
  lost = false;
  CHECK(next_of(first).verdict == SampleVerdict::kAsPredicted);
  lost = true;
  CHECK(next_of(first).verdict == SampleVerdict::kLost);
  CHECK(next_of(first).verdict == SampleVerdict::kLost);
  first.end();
  auto second = bench.prepared();
  CHECK(codes(bench.sink).empty());
  const auto last = next_of(second);
  CHECK(last.verdict == SampleVerdict::kLostTooOften);
  CHECK(last.record.reason == "numbers blew up");
  CHECK(last.record.retries == 1);
  CHECK(codes(bench.sink) == std::vector<std::string>{"E7107"});
}

TEST_CASE("a start is refused where the simulator cannot be put into it") {
  Trials bench;
  bench.script.box_settable = false;
  bench.start();
  auto trace = bench.feed->next();
  REQUIRE(trace.has_value());
  CHECK_FALSE(Trial::prepare(*bench.bench, *std::move(*trace)).has_value());
  CHECK(codes(bench.sink) == std::vector<std::string>{"E5116"});
}

TEST_CASE("what cannot be judged fails once and is reported") {
  Trials bench;
  std::string code;
  SUBCASE("a refused action") { bench.script.refuses = "placing", code = "E7109"; }
  SUBCASE("a missing variable") { bench.script.hides_box = true, code = "E7109"; }
  SUBCASE("another start") { bench.script.start_shift_m = 1.0, code = "E7112"; }
  SUBCASE("another start of the built-in simulator") {
    pretend_built_in(bench.scenario);
    for (auto& action : bench.scenario.actions) {
      if (action.controller != "picking-up") action.arguments["target.x"] = 0.5;
    }
    bench.script.start_shift_m = 1.0, code = "E7106";
  }
  SUBCASE("no valid start") {
    bench.script.invalid = [](const State&) { return true; }, code = "E7105";
  }
  bench.start();
  auto trial = bench.prepared();
  CHECK_FALSE(trial.next().has_value());
  CHECK(codes(bench.sink) == std::vector<std::string>{code});
}

TEST_CASE("a sample is repeated with its own start and seed, and the trial can go on") {
  Trials bench;
  bench.start();
  auto trial = bench.prepared();
  trial.submit_to(5);
  const auto sample = next_of(trial);
  const auto again = trial.repeat(sample.record);
  REQUIRE(again.has_value());
  CHECK(again->phase == DrawPhase::kConfirm);
  auto expected = sample.record;
  expected.phase = DrawPhase::kConfirm;
  CHECK(*again == expected);
  CHECK(next_of(trial).record.sample == 2);
}

TEST_CASE("what is on record is not simulated") {
  Trials bench;
  bench.scenario.limits.max_runs = 4;
  REQUIRE(bench.run().has_value());  // leaves a journal
  bench.script.loses = [](const State&) { return true; };
  bench.start();
  auto folder = RunFolder::claim(bench.options.run_dir, true, bench.sink);
  REQUIRE(folder.has_value());
  const auto header =
      journal_header(bench.scenario, bench.options, ScriptedSimulator(bench.script).info());
  auto recorded = read_for_continuation(*folder, header, bench.files, bench.sink);
  REQUIRE(recorded.has_value());
  const auto journal =
      Journal::open(*std::move(folder), header, *std::move(recorded), 3, bench.files, bench.sink);
  REQUIRE(journal.has_value());
  auto trial = bench.prepared();
  trial.continue_from(**journal);
  for (int number = 1; number <= 4; ++number) {
    CHECK(next_of(trial).verdict == SampleVerdict::kAsPredicted);
  }
  CHECK(bench.finished == 0);
  CHECK(next_of(trial).verdict == SampleVerdict::kLost);
  CHECK(bench.finished == 1);
}

TEST_CASE("the stop flag ends the wait") {
  Trials bench;
  bench.start();
  auto trial = bench.prepared();
  next_of(trial);
  bench.stop = true;
  const auto sample = trial.next();
  REQUIRE(sample.has_value());
  CHECK_FALSE(sample->has_value());
}

}  // namespace
}  // namespace parallax::harness::test
