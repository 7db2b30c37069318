#include "harness/campaign/replay.h"

#include "harness/report/report.h"
#include "tests/harness/campaign/two_regions.h"

namespace parallax::harness::test {
namespace {

struct Recorded : Bench {
  Recorded() {
    script.drops = box_far;
    const auto result = run();
    REQUIRE(result.has_value());
    REQUIRE(result->discrepancies.size() == 1);
    found = {1, result->discrepancies[0].sample};
  }
  base::Result<ReplayResult> replay(std::optional<SampleId> id, const std::string& hash = "5ce0") {
    simulators = 0;
    const auto factory = [this] {
      ++simulators;
      return std::make_unique<ScriptedSimulator>(script);
    };
    const auto recorded = read_recorded_run(options.run_dir, id, files, sink);
    if (!recorded) return sink.already_reported();
    return replay_sample(*recorded, hash, factory);
  }
  SampleId found;
};

TEST_CASE("every recorded simulation can be repeated bit for bit") {
  Recorded bench;
  for (std::int64_t sample = 1; sample <= bench.found.sample; ++sample) {
    const auto result = bench.replay(SampleId{1, sample});
    REQUIRE(result.has_value());
    CHECK(result->outcome == ReplayOutcome::kIdentical);
    CHECK(result->timepoints == 5);
  }
}

TEST_CASE("without a number the discrepancy is repeated") {
  Recorded bench;
  const auto result = bench.replay(std::nullopt);
  REQUIRE(result.has_value());
  CHECK(result->id.sample == bench.found.sample);
  CHECK(replay_text(*result, {}).find("identical") != std::string::npos);
}

TEST_CASE("a repetition that differs shows the first value with its bits") {
  Recorded bench;
  bench.script.drops = Script::never;
  const auto result = bench.replay(bench.found);
  REQUIRE(result.has_value());
  CHECK(result->outcome == ReplayOutcome::kDiffers);
  REQUIRE(result->difference.has_value());
  CHECK(result->difference->timepoint == 2);
  CHECK(result->difference->variable == "act: status");
  CHECK(replay_json(*result).find("\"outcome\":\"differs\"") != std::string::npos);
  bench.script.drops = box_far;
  bench.script.deterministic = false;
  const auto noisy = bench.replay(bench.found);
  REQUIRE(noisy.has_value());
  CHECK(noisy->difference->variable == "robot.x");
  CHECK(noisy->difference->repeated.find("(0x1.") != std::string::npos);
}

TEST_CASE("another scenario or a simulator that is lost cannot repeat") {
  Recorded bench;
  const auto other = bench.replay(bench.found, "other");
  REQUIRE(other.has_value());
  CHECK(other->outcome == ReplayOutcome::kCannot);
  CHECK(other->reason.find("has changed") != std::string::npos);
  CHECK(bench.simulators == 0);
  bench.script.loses = [](const State&) { return true; };
  const auto lost = bench.replay(bench.found);
  REQUIRE(lost.has_value());
  CHECK(lost->outcome == ReplayOutcome::kCannot);
  CHECK(replay_text(*lost, {}).find("numbers blew up") != std::string::npos);
}

TEST_CASE("a simulation or a run that is not there is a usage error") {
  Recorded bench;
  CHECK_FALSE(bench.replay(SampleId{1, 4000}).has_value());
  CHECK(codes(bench.sink) == std::vector<std::string>{"E7110"});
  CHECK(bench.sink.exit_code() == 2);
  CHECK(bench.simulators == 0);
  base::DiagnosticSink sink;
  CHECK_FALSE(read_recorded_run(bench.folder.path(), {}, bench.files, sink).has_value());
  CHECK(codes(sink) == std::vector<std::string>{"E7111"});
  base::DiagnosticSink none;
  const auto run = read_recorded_run(bench.options.run_dir, {}, bench.files, none);
  REQUIRE(run.has_value());
  CHECK(run->header.scenario == "scenario.yaml");
  CHECK(run->header.seed == 1);
}

TEST_CASE("a sample is named by two whole numbers") {
  REQUIRE(parse_sample_id("2.4").has_value());
  CHECK(parse_sample_id("2.4")->trace == 2);
  CHECK(parse_sample_id("2.4")->sample == 4);
  for (const auto* bad : {"", "2", "2.", ".4", "0.1", "1.0", "-1.2", "1.2.3", "1.2x", " 1.2",
                          "99999999999999999999.1"}) {
    CHECK_FALSE(parse_sample_id(bad).has_value());
  }
}

}  // namespace
}  // namespace parallax::harness::test
