#include "harness/campaign/journal.h"
#include "harness/campaign/worker_pool.h"
#include "harness/report/report.h"
#include "tests/harness/campaign/two_regions.h"

namespace parallax::harness::test {
namespace {

TEST_CASE("a folder belongs to one run at a time, and to the next when it is given back") {
  TempFolder temp;
  const auto path = temp.path() / "run";
  base::DiagnosticSink sink;
  {
    const auto first = RunFolder::claim(path, false, sink);
    REQUIRE(first.has_value());
    CHECK_FALSE(RunFolder::claim(path, true, sink).has_value());
    CHECK(codes(sink) == std::vector<std::string>{"E7181"});
    CHECK(std::filesystem::is_empty(path));  // no lock file
  }
  CHECK_FALSE(std::filesystem::exists(path));  // made in vain
  CHECK(RunFolder::claim(path, true, sink).has_value());
}

TEST_CASE("a folder that was there before stays, and a file is no folder") {
  TempFolder temp;
  base::DiagnosticSink sink;
  CHECK(RunFolder::claim(temp.path(), false, sink).has_value());
  CHECK(std::filesystem::exists(temp.path()));
  CHECK_FALSE(RunFolder::claim(temp.write("file", ""), false, sink).has_value());
  CHECK(sink.error_count() == 1);
}

TEST_CASE("a folder in use is refused before any simulator is started") {
  Bench bench;
  bench.scenario.limits.max_runs = 3;
  REQUIRE(bench.run().has_value());
  bench.simulators = 0;
  SUBCASE("by a journal") { CHECK_FALSE(bench.run().has_value()); }
  SUBCASE("by another run") {
    base::DiagnosticSink sink;
    const auto other = RunFolder::claim(bench.options.run_dir, true, sink);
    bench.options.resume = true;
    CHECK_FALSE(bench.run().has_value());
  }
  CHECK(bench.simulators == 0);
}

TEST_CASE("a folder is held from before the first simulation to the end of the run") {
  Bench bench;
  int claims = 0;
  bench.options.progress = [&](const CampaignProgress&) {
    base::DiagnosticSink sink;
    CHECK_FALSE(RunFolder::claim(bench.options.run_dir, true, sink).has_value());
    ++claims;
  };
  REQUIRE(bench.run().has_value());
  CHECK(claims == 91);
}

TEST_CASE("a run that was stopped before it had its journal says so") {
  Bench bench;
  bench.scenario.limits.max_runs = 3;
  auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(result->journal_open);
  std::atomic<bool> stop = true;
  bench.options.stop = &stop;
  bench.options.resume = true;
  bench.script.on_info = [] { std::this_thread::sleep_for(std::chrono::milliseconds(200)); };
  result = bench.run();
  REQUIRE(result.has_value());
  CHECK(result->interrupted);
  CHECK_FALSE(result->journal_open);
}

TEST_CASE("a run whose simulator does not start leaves no folder behind") {
  Bench bench;
  bench.script.start_failure = "no licence";
  CHECK_FALSE(bench.run().has_value());
  CHECK_FALSE(std::filesystem::exists(bench.options.run_dir));
}

TEST_CASE("closing a pool never waits for a worker that missed the call") {
  for (int i = 0; i < 2000; ++i) {
    const auto factory = [] { return std::make_unique<ScriptedSimulator>(Script()); };
    WorkerPool pool(
        8, factory, [](const SampleRecord&) {}, nullptr);
    pool.close();
  }
}

/// Runs with a simulator that is lost for these samples of the trace, as long as `broken`.
struct Losing : Bench {
  std::vector<State> starts;
  bool broken = true;
  explicit Losing(const std::vector<std::int64_t>& samples) {
    for (const auto sample : samples) starts.push_back(drawn_start(*this, 1, sample));
    script.loses = [this](const State& start) {
      return broken && std::find(starts.begin(), starts.end(), start) != starts.end();
    };
  }
};

TEST_CASE("a loss is recorded once however often it is simulated again") {
  Losing bench({7, 8});
  std::atomic<bool> stop = false;
  bench.options.stop = &stop;
  bench.options.progress = [&](const CampaignProgress& p) { stop = p.done >= 8; };
  for (int i = 0; i < 3; ++i) {
    stop = false;
    const auto result = bench.run();
    REQUIRE(result.has_value());
    CHECK(result->interrupted);
    bench.options.resume = true;
  }
  bench.options.stop = nullptr;
  bench.options.progress = nullptr;
  bench.broken = false;
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(result->verdict == CampaignVerdict::kNoDiscrepancy);
  CHECK(result->traces[0].lost == 0);
  CHECK(result->simulations == 90);
}

TEST_CASE("losses at which an unfinished run would end at once again are simulated again") {
  std::int64_t first_lost = 0;
  SUBCASE("the last ones") { first_lost = 6; }
  SUBCASE("as many in a row as end a run, where others ran ahead") { first_lost = 4; }
  Bench bench;
  bench.scenario.limits.max_runs = 8;
  REQUIRE(bench.run().has_value());
  // Header, trace and samples 1 to 8, of which three in a row become losses.
  std::istringstream lines(slurp(bench.journal()));
  std::string journal, line;
  for (std::int64_t sample = -1; std::getline(lines, line); ++sample) {
    if (sample >= first_lost && sample < first_lost + 3) {
      line.replace(line.find("\"ok\""), 4, "\"lost\"");
    }
    journal += line + '\n';
  }
  std::ofstream(bench.journal(), std::ios::binary) << journal;
  bench.sink = base::DiagnosticSink();
  bench.scenario.limits.max_runs = 0;
  bench.options.resume = true;
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(codes(bench.sink, kLowLimit).empty());
  CHECK(result->verdict == CampaignVerdict::kNoDiscrepancy);
  CHECK(result->timing.runs_made == 90 - 5);
}

TEST_CASE("a record whose number is not what it was drawn from is refused with its place") {
  Bench bench;
  bench.scenario.limits.max_runs = 3;
  REQUIRE(bench.run().has_value());
  auto text = slurp(bench.journal());
  std::string what;
  SUBCASE("start") {
    const auto at = text.find("\"box.x\":1.", text.find("\"sample\":2"));
    const auto digit = at + 10;
    text[digit] = text[digit] == '5' ? '6' : '5';
    what = "its start";
  }
  SUBCASE("seed") {
    const auto at = text.find("\"seed\":", text.find("\"sample\":2")) + 7;
    text[at] = text[at] == '1' ? '2' : '1';
    what = "its seed";
  }
  SUBCASE("attempt") {
    text.replace(text.find("\"attempt\":0", text.find("\"sample\":2")), 11, "\"attempt\":1");
    what = "its start";
  }
  std::ofstream(bench.journal(), std::ios::binary) << text;
  bench.options.resume = true;
  CHECK_FALSE(bench.run().has_value());
  REQUIRE(codes(bench.sink, kLowLimit) == std::vector<std::string>{"E7103"});
  const auto diagnostic = first_error(bench.sink);
  CHECK(diagnostic.message.find(what) != std::string::npos);
  REQUIRE(diagnostic.range.has_value());
  CHECK(bench.files[diagnostic.range->file].position(diagnostic.range->begin).line == 4);
  CHECK(slurp(bench.journal()) == text);
}

TEST_CASE("an observation that the journal lacks is the journal's fault, not the simulator's") {
  Bench bench;
  bench.scenario.limits.max_runs = 3;
  REQUIRE(bench.run().has_value());
  auto text = slurp(bench.journal());
  const auto at = text.find("\"box.x\":", text.find("\"observations\"", text.find("\"sample\":2")));
  text.erase(at, text.find(',', at) + 1 - at);
  std::ofstream(bench.journal(), std::ios::binary) << text;
  bench.options.resume = true;
  CHECK_FALSE(bench.run().has_value());
  REQUIRE(codes(bench.sink, kLowLimit) == std::vector<std::string>{"E7103"});
  const auto diagnostic = first_error(bench.sink);
  CHECK(diagnostic.message.find("its observations lack `box.x`") != std::string::npos);
  REQUIRE(diagnostic.range.has_value());
  CHECK(bench.files[diagnostic.range->file].position(diagnostic.range->begin).line == 4);
}

TEST_CASE("a run may be continued with another limit and from another folder") {
  Bench bench;
  bench.scenario.limits.max_runs = 20;
  const auto cut = bench.run();
  REQUIRE(cut.has_value());
  CHECK(cut->verdict == CampaignVerdict::kInconclusive);
  bench.sink = base::DiagnosticSink();
  bench.scenario.limits.max_runs = 0;
  bench.scenario.name = "elsewhere/scenario.yaml";
  auto text = slurp(bench.journal());
  text.replace(text.find("fetch.lisp:2"), 12, "elsewhere/fetch.lisp:2");
  std::ofstream(bench.journal(), std::ios::binary) << text;
  bench.options.resume = true;
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK(codes(bench.sink, kLowLimit).empty());
  CHECK(result->verdict == CampaignVerdict::kNoDiscrepancy);
  CHECK(result->timing.runs_made == 70);
}

}  // namespace
}  // namespace parallax::harness::test
