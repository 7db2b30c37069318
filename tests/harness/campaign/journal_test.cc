#include "harness/campaign/journal.h"

#include "harness/campaign/sample_record.h"
#include "harness/report/report.h"
#include "tests/harness/campaign/two_regions.h"

namespace parallax::harness::test {
namespace {

struct Outputs {
  std::string journal, text, json;
  friend bool operator==(const Outputs&, const Outputs&) = default;
};

/// Runs with the journal `before` in place and returns the content of the run folder afterwards.
Outputs continued_from(const std::string* before, std::int64_t jobs) {
  Bench bench;
  bench.script.drops = box_far;
  bench.options.keep_going = true;
  bench.options.jobs = jobs;
  bench.traces = 2;
  bench.options.resume = before != nullptr;
  if (before != nullptr) {
    std::filesystem::create_directories(bench.options.run_dir);
    std::ofstream(bench.journal(), std::ios::binary) << *before;
  }
  auto result = bench.run();
  REQUIRE(result.has_value());
  result->replay_folder = "run";  // a temporary folder, another one each time
  REQUIRE(write_report(*result, bench.options.run_dir, bench.sink).has_value());
  return {slurp(bench.journal()), slurp(bench.options.run_dir / "report.txt"),
          slurp(bench.options.run_dir / "report.json")};
}

TEST_CASE("a run that ends after any line of its journal is continued to the same bytes") {
  const auto whole = continued_from(nullptr, 1);
  std::size_t lines = 0;
  for (std::size_t end = 0; end < whole.journal.size(); ++end) {
    const bool after_line = end == 0 || whole.journal[end - 1] == '\n';
    const bool inside_line = end % 997 == 0;
    if (!after_line && !inside_line) continue;
    const auto before = whole.journal.substr(0, end);
    CAPTURE(end);
    CHECK(continued_from(&before, 1 + static_cast<std::int64_t>(end % 3)) == whole);
    ++lines;
  }
  CHECK(lines > 20);
}

TEST_CASE("a cut last line is dropped with a warning and nothing that was finished is repeated") {
  Bench bench;
  bench.scenario.limits.max_runs = 10;
  REQUIRE(bench.run().has_value());
  const auto whole = slurp(bench.journal());
  std::ofstream(bench.journal(), std::ios::binary) << whole.substr(0, whole.size() - 5);
  bench.options.resume = true;
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(codes(bench.sink, kLowLimit) == std::vector<std::string>{"W7104"});
  CHECK(result->timing.runs_made == 1);
  CHECK(slurp(bench.journal()) == whole);
}

TEST_CASE("a stopped run keeps what was finished, says so, and is continued to the same bytes") {
  Bench whole;
  const auto expected = whole.run();
  REQUIRE(expected.has_value());

  Bench bench;
  std::atomic<bool> stop = false;
  bench.options.stop = &stop;
  bench.options.jobs = 2;
  bench.options.progress = [&](const CampaignProgress& p) { stop = p.done >= 30; };
  const auto stopped = bench.run();
  REQUIRE(stopped.has_value());
  CHECK(stopped->interrupted);
  CHECK(stopped->verdict == CampaignVerdict::kInconclusive);
  CHECK(stopped->exploration == "stopped");
  CHECK(campaign_text(*stopped, {}).find("interrupted") != std::string::npos);
  stop = false;
  bench.options.progress = nullptr;
  bench.options.resume = true;
  const auto continued = bench.run();
  REQUIRE(continued.has_value());
  CHECK_FALSE(continued->interrupted);
  CHECK(continued->timing.runs_made <= 60);
  CHECK(slurp(bench.journal()) == slurp(whole.journal()));
}

TEST_CASE("a folder that holds a run is not touched without --resume") {
  Bench bench;
  bench.scenario.limits.max_runs = 3;
  REQUIRE(bench.run().has_value());
  const auto before = slurp(bench.journal());
  CHECK_FALSE(bench.run().has_value());
  CHECK(codes(bench.sink, kLowLimit) == std::vector<std::string>{"E7101"});
  CHECK(bench.sink.exit_code() == 2);
  CHECK(slurp(bench.journal()) == before);
}

TEST_CASE("a journal of another run is refused with the field that differs") {
  Bench bench;
  bench.scenario.limits.max_runs = 3;
  REQUIRE(bench.run().has_value());
  const auto before = slurp(bench.journal());
  bench.options.resume = true;
  std::string field;
  int simulators = 0;  // made before the difference was found
  SUBCASE("seed") { bench.options.seed = 9, field = "its seed is 1, now it is 9"; }
  SUBCASE("inputs") { bench.options.scenario_hash = "1", field = "its scenario_hash is"; }
  SUBCASE("version") { bench.options.tool_version = "0.2", field = "its tool_version is"; }
  SUBCASE("epsilon") {
    bench.scenario.criterion.epsilon = 0.1, field = "its options.criterion.epsilon is 0.05";
  }
  SUBCASE("keep going") { bench.options.keep_going = true, field = "its options.keep_going is"; }
  SUBCASE("simulator") {
    bench.script.determinism = "tolerance", field = "its simulator.determinism is";
    simulators = 1;
  }
  bench.simulators = 0;
  CHECK_FALSE(bench.run().has_value());
  CHECK(bench.simulators == simulators);
  REQUIRE(codes(bench.sink, kLowLimit) == std::vector<std::string>{"E7102"});
  const auto diagnostic = first_error(bench.sink);
  CHECK(diagnostic.message.find(field) != std::string::npos);
  CHECK(diagnostic.range.has_value());
  CHECK(slurp(bench.journal()) == before);
}

TEST_CASE("a line that is not ours is refused with its place") {
  Bench bench;
  bench.scenario.limits.max_runs = 3;
  REQUIRE(bench.run().has_value());
  const auto whole = slurp(bench.journal());
  const auto second = whole.find('\n') + 1;
  const auto third = whole.find('\n', second) + 1;
  bench.options.resume = true;
  std::string foreign;
  SUBCASE("words") { foreign = "hello\n"; }
  SUBCASE("other JSON") { foreign = "{\"a\":1}\n"; }
  SUBCASE("a list") { foreign = "[1,2]\n"; }
  SUBCASE("bytes") { foreign = std::string("\xff\xfe\0x", 4) + "\n"; }
  SUBCASE("nesting") { foreign = std::string(100000, '[') + "\n"; }
  SUBCASE("an empty line") { foreign = "\n"; }
  SUBCASE("a line twice") { foreign = whole.substr(third, whole.find('\n', third) + 1 - third); }
  SUBCASE("a trace twice") { foreign = whole.substr(second, third - second); }
  SUBCASE("a sample of no trace") {
    foreign = whole.substr(third, whole.find('\n', third) + 1 - third);
    foreign.replace(foreign.find("\"trace\":1"), 9, "\"trace\":7");
  }
  SUBCASE("a wrong type") {
    foreign = whole.substr(third, whole.find('\n', third) + 1 - third);
    foreign.replace(foreign.find("\"sample\":1"), 10, "\"sample\":\"x\"");
  }
  const auto end = whole.find('\n', third) + 1;
  const auto spoilt = whole.substr(0, end) + foreign + whole.substr(end);
  std::ofstream(bench.journal(), std::ios::binary) << spoilt;
  CHECK_FALSE(bench.run().has_value());
  REQUIRE(codes(bench.sink, kLowLimit) == std::vector<std::string>{"E7103"});
  const auto diagnostic = first_error(bench.sink);
  REQUIRE(diagnostic.range.has_value());
  CHECK(bench.files[diagnostic.range->file].position(diagnostic.range->begin).line == 4);
  CHECK(slurp(bench.journal()) == spoilt);
}

TEST_CASE("a trace that is no longer the one that was recorded is refused") {
  Bench bench;
  bench.scenario.limits.max_runs = 3;
  REQUIRE(bench.run().has_value());
  auto text = slurp(bench.journal());
  text.replace(text.find("fetch 1"), 7, "fetch 9");
  std::ofstream(bench.journal(), std::ios::binary) << text;
  bench.options.resume = true;
  CHECK_FALSE(bench.run().has_value());
  CHECK(codes(bench.sink, kLowLimit) == std::vector<std::string>{"E7102"});
}

TEST_CASE("records come back from their line to the last bit") {
  SampleRecord record;
  record.trace = 3;
  record.sample = 14;
  record.attempt = record.rejected = 2;
  record.retries = 1;
  record.seed = (std::uint64_t{1} << 53U) - 1;
  record.reason = "quote \" and \xc3\xa4";
  record.initial = {{"a", 0.1}, {"b", -0.0}, {"c", 5e-324}, {"d", 1.7976931348623157e308}};
  record.observations = {
      {{"n", std::int64_t{-7}}, {"f", true}, {"x", 3.0}, {"t", std::string("w")}}, {}};
  record.outcomes = {{SimStatus::kTruncated, "late", 0.30000000000000004}};
  record.digest = "00ff";
  const auto decoded = decode_line(encode(record), table_of({}));
  const auto* back = std::get_if<SampleRecord>(&decoded);
  REQUIRE(back != nullptr);
  CHECK(*back == record);
  CHECK_FALSE(first_difference(record, *back).has_value());
  CHECK(std::signbit(std::get<double>(back->initial.at("b"))));
  CHECK(std::holds_alternative<double>(back->observations[0].at("x")));
}

TEST_CASE("comparison is by bits and names the first value that differs") {
  SampleRecord a;
  a.observations = {{{"x", 0.0}}, {{"x", 1.0}, {"y", 2.0}}};
  a.outcomes = {{}};
  SampleRecord b = a;
  CHECK_FALSE(first_difference(a, b).has_value());
  b.observations[0]["x"] = -0.0;
  CHECK(first_difference(a, b)->timepoint == 0);
  CHECK(first_difference(a, b)->b == "-0 (-0x0p+0)");
  b = a;
  b.observations[1]["y"] = std::nextafter(2.0, 3.0);
  CHECK(first_difference(a, b)->variable == "y");
  CHECK(first_difference(a, b)->b.find("2.0000000000000004") == 0);
  b = a;
  b.observations[1]["z"] = 1.0;
  CHECK(first_difference(a, b)->a == "absent");
  b = a;
  b.outcomes[0].status = SimStatus::kFailed;
  CHECK(first_difference(a, b)->variable == "act: status");
  b = a;
  b.digest = "1";
  CHECK(first_difference(a, b)->variable == "digest");
}

}  // namespace
}  // namespace parallax::harness::test
