// Starts drawn by a law through whole campaigns: claims, counts, records and searches.

#include <cmath>
#include <fstream>

#include "compiler/base/codes/campaigns.h"
#include "harness/campaign/rates.h"
#include "harness/campaign/trial.h"
#include "harness/report/report.h"
#include "tests/harness/campaign/two_regions.h"

namespace parallax::harness::test {
namespace {

std::string with_sampling(const std::string& sampling) {
  return std::string(kScenarioText) + "sampling: " + sampling + "\n";
}

/// Robot uniform in 0 to 1, box in 1 to 2, given that they are more than 1.2 apart: 0.32 of the
/// square, and of that 0.234375 has the box beyond 1.9.
const std::string kApart = with_sampling("{require: [\"box.x - robot.x > 1.2\"]}");
constexpr double kApartShare = 0.32, kApartFar = 0.234375;

struct LawBench : Bench {
  using Bench::Bench;
  RatesOptions rates;
  RatesResult estimate(std::int64_t runs) {
    rates.runs = runs;
    // A correct program misses the true rate once in a million times.
    rates.confidence = 1.0 - 1e-6;
    ListFeed feed(traces, openness);
    const auto factory = [this] { return std::make_unique<ScriptedSimulator>(script); };
    auto result = estimate_rates(scenario, feed, factory, rates, sink);
    REQUIRE(result.has_value());
    return *std::move(result);
  }
  std::string read_journal() const {
    std::ifstream in(journal());
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

TEST_CASE("rates are about the scenario's law: their intervals have its discrepancy probability") {
  // A normal box position, cut by its cell: (Phi(2.5) - Phi(1)) / (Phi(2.5) - Phi(-2.5)).
  LawBench bench(with_sampling("{variables: {box.x: {normal: {mean: 1.5, sd: 0.2}}}}"));
  bench.script.drops = [](const State& start) { return number(start, "box.x") > 1.7; };
  const auto phi = [](double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); };
  const double p = (phi(2.5) - phi(1.0)) / (phi(2.5) - phi(-2.5));
  const auto result = bench.estimate(3000);
  const auto& trace = result.traces[0];
  CHECK(trace.any.lower < p);
  CHECK(trace.any.upper > p);
  CHECK(trace.any.upper < 0.3);  // the value for uniform starts
  REQUIRE(trace.law.has_value());
  CHECK(trace.law->refused == 0);
  CHECK(rates_text(result).find("box.x normal with mean 1.5 and sd 0.2 within 1 to 2") !=
        std::string::npos);
}

TEST_CASE("what a condition refuses is counted, whatever the number of workers") {
  LawBench bench(kApart);
  bench.script.drops = box_far;
  bench.rates.jobs = 3;
  const auto result = bench.estimate(3000);
  const auto& trace = result.traces[0];
  CHECK(trace.any.lower < kApartFar);
  CHECK(trace.any.upper > kApartFar);
  REQUIRE(trace.law.has_value());
  CHECK(trace.law->drawn == 3000);
  CHECK(trace.law->refused_share() == doctest::Approx(1.0 - kApartShare).epsilon(0.03));
  REQUIRE(trace.law->conditions.size() == 1);
  CHECK(trace.law->conditions[0].text == "box.x - robot.x > 1.2");
  CHECK(trace.law->conditions[0].refused == trace.law->refused);
  LawBench alone(kApart);
  alone.script.drops = box_far;
  CHECK(rates_json(alone.estimate(3000)) == rates_json(result));
}

TEST_CASE("a claim says its law, the report what was refused, and the journal how often") {
  LawBench bench(kApart);
  const auto result = bench.run();
  REQUIRE(result.has_value());
  REQUIRE(result->verdict == CampaignVerdict::kNoDiscrepancy);
  const std::string said =
      "start states drawn from the start region by the scenario's law (given box.x - robot.x > "
      "1.2) "
      "give a discrepancy";
  CHECK(result->traces[0].claim.find(said) != std::string::npos);
  CHECK(result->claim.find(said) != std::string::npos);
  const auto& law = result->traces[0].law;
  REQUIRE(law.has_value());
  CHECK(law->drawn == 90);
  CHECK(law->refused > 90);
  const auto journal = bench.read_journal();
  CHECK(journal.find("\"redrawn\":") != std::string::npos);
  // Each sample's number stands in its line.
  std::int64_t sum = 0;
  for (auto at = journal.find("\"redrawn\":"); at != std::string::npos;
       at = journal.find("\"redrawn\":", at + 1)) {
    sum += std::stoll(journal.substr(at + 10));
  }
  CHECK(sum == law->refused);
  CHECK(campaign_text(*result, {}).find("candidates") != std::string::npos);
  for (const auto& line : {"\"words\"", "\"refused_share\"", "\"conditions\""}) {
    CHECK(campaign_json(*result, false).find(line) != std::string::npos);
  }
}

TEST_CASE("a run by a law goes on where it stopped, and knows a forged count") {
  LawBench bench(kApart);
  const auto whole = bench.run();
  REQUIRE(whole.has_value());
  auto journal = bench.read_journal();
  bench.options.resume = true;
  const auto again = bench.run();
  REQUIRE(again.has_value());
  CHECK(again->timing.runs_made == 0);
  CHECK(bench.read_journal() == journal);
  const auto at = journal.find("\"redrawn\":");
  journal.insert(at + 10, "7");
  std::ofstream(bench.journal(), std::ios::binary) << journal;
  CHECK_FALSE(bench.run().has_value());
  CHECK(first_error(bench.sink).code == codes::kForeignJournalLine);
}

TEST_CASE("a search looks among the law's starts, and what is claimed comes from draws") {
  LawBench bench(kApart);
  bench.scenario.search.runs = 40;
  const auto result = bench.run();
  REQUIRE(result.has_value());
  const auto& trace = result->traces[0];
  REQUIRE(trace.search.has_value());
  CHECK(trace.search->invalid > 0);
  CHECK(trace.search->runs + trace.search->invalid == 40);
  REQUIRE(trace.law.has_value());
  CHECK(trace.law->drawn == 90);
  base::SourceFiles files;
  std::ifstream in(bench.journal());
  std::string line;
  std::int64_t searched = 0;
  while (std::getline(in, line)) {
    if (line.find("\"phase\":\"search\"") == std::string::npos) continue;
    ++searched;
    const auto value = [&](const std::string& name) {
      const auto at = line.find("\"" + name + "\":", line.find("\"initial\""));
      return std::stod(line.substr(at + name.size() + 3));
    };
    CHECK(value("box.x") - value("robot.x") > 1.2);
  }
  CHECK(searched == trace.search->runs);
  bench.options.resume = true;
  const auto again = bench.run();
  REQUIRE(again.has_value());
  CHECK(again->timing.runs_made == 0);
}

TEST_CASE("a scenario without a law says and records nothing of one") {
  LawBench bench;
  const auto result = bench.run();
  REQUIRE(result.has_value());
  CHECK_FALSE(result->traces[0].law.has_value());
  CHECK(result->traces[0].claim.find("drawn uniformly from the start region") != std::string::npos);
  CHECK(bench.read_journal().find("redrawn") == std::string::npos);
  // The law of initial states is a word.
  CHECK(campaign_json(*result, false).find("\"law\":{") == std::string::npos);
}

TEST_CASE("regions with a shape: m and its inverse agree, and starts are uniform in it") {
  LawBench bench(R"(model: domain.e
horizon: 4
simulator: {command: [scripted]}
regions:
  gaps: allowed
  cells:
    r1: {disc: {at_m: [0.5, 0], radius_m: 0.5}}
    r2: {x: [1, 2], y: [-1, 1], start: {ring: {at_m: [1.5, 0], inner_m: 0.2, outer_m: 0.4}}}
mapping:
  RobotIn(region): {inside: region, body: robot}
  BoxIn(region): {inside: region, body: box}
  Holding(): ignored
actions: {Go(r): {controller: going}, PickUp(): {controller: going}, Place(): {controller: going}}
)");
  const auto& mapping = *bench.scenario.mapping;
  std::vector<GroundFluent> fluents;
  for (const auto* text : {"RobotIn(r1)", "RobotIn(r2)", "BoxIn(r1)", "BoxIn(r2)", "Holding()"}) {
    fluents.push_back(ground_fluent(text));
  }
  const std::set<std::string> holds = {"RobotIn(r1)", "BoxIn(r2)"};
  const auto sampler = start_sampler(bench.scenario, fluents, holds, bench.sink);
  REQUIRE(sampler.has_value());
  std::int64_t inner = 0;
  constexpr std::uint64_t kDraws = 5000;
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    const auto start = sampler->draw({.campaign_seed = 6, .sample = i});
    CHECK(mapping.wrong_at_start(fluents, holds, start).empty());
    const double robot = std::hypot(number(start, "robot.x") - 0.5, number(start, "robot.y"));
    CHECK(robot <= 0.5);
    inner += robot < 0.25 ? 1 : 0;
    const double box = std::hypot(number(start, "box.x") - 1.5, number(start, "box.y"));
    CHECK(box >= 0.2 - 1e-9);
    CHECK(box <= 0.4 + 1e-9);
  }
  CHECK(static_cast<double>(inner) / kDraws == doctest::Approx(0.25).epsilon(0.15));
  // In the corner of the disc's square the robot is in no region.
  const State corner = {{"robot.x", 0.02}, {"robot.y", 0.45}};
  CHECK_FALSE(*mapping.holds(fluents[0], corner));
  CHECK(*mapping.holds(fluents[0], {{"robot.x", 0.2}, {"robot.y", 0.2}}));
}

}  // namespace
}  // namespace parallax::harness::test
