// The two rules for judging an end state, and numbers of a designator that reach the simulated
// motion.

#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

/// edge.yaml with another last axiom group: the effect of placing is left open. `released` are the
/// fluents that it releases, `ok` the plan's condition for success.
void open_placing(const CliFixture& cli, const std::string& released, const std::string& ok) {
  cli.replace("domain.e", "Initiates(Place(region),BoxIn(region),time).", released);
  cli.replace("robot.bind", "ok: BoxIn(region(?p)) @t+1\n                             else manip",
              "ok: " + ok + " @t+1\n                             else manip");
  cli.replace("edge.yaml", "Happens(Place(region),time-1) & HoldsAt(BoxIn(region),time)",
              "Happens(Place(region),time-1)");
}

/// The box that is placed comes to lie in some region.
void leave_region_open(const CliFixture& cli) {
  open_placing(cli,
               "Releases(Place(region),BoxIn(region),time).\n[region1,region2,time]\n"
               "HoldsAt(Holding(),time) & HoldsAt(RobotIn(region1),time) -> "
               "Releases(Place(region1),BoxIn(region2),time).",
               "!Holding()");
}

Json run(const CliFixture& cli, const std::vector<std::string>& options, int expected_code) {
  std::vector<std::string> words = {"run", "edge.yaml", "--epsilon", "0.4"};
  words.insert(words.end(), options.begin(), options.end());
  return json_of(cli, words, expected_code);
}

std::int64_t count(const CliFixture& cli, const std::string& match, const std::string& runs) {
  const auto result = json_of(cli, {"rates", "edge.yaml", "--runs", runs, "--match", match});
  return result["traces"][0]["any"]["count"];
}

TEST_CASE("an end that the trace does not have and the model admits: trace reports, model not") {
  const CliFixture cli;
  leave_region_open(cli);
  const auto strict = run(cli, {"--match", "trace", "--out", "trace"}, 1);
  CHECK(strict["verdict"] == "discrepancy");
  for (const auto& fluent : strict["discrepancies"][0]["fluents"]) {
    CHECK(fluent["fluent"].get<std::string>().starts_with("BoxIn("));
    CHECK(fluent["timepoint"] == 4);
  }

  const auto lenient = run(cli, {"--out", "default"}, 0);
  CHECK(lenient["verdict"] == "no-discrepancy");
  const auto& trace = lenient["traces"][0];
  CHECK(trace["simulations"] == 10);  // ln 0.01 / ln 0.6, rounded up
  const std::int64_t admitted = trace["admitted"];
  CHECK(admitted > 0);
  CHECK(admitted < 10);

  // The scenario's key holds until the command line overrides it.
  cli.replace("edge.yaml", "horizon: 6", "horizon: 6\nmatch: trace");
  CHECK(run(cli, {"--out", "said"}, 1)["verdict"] == "discrepancy");
  // The same starts: those that one rule admits, the other counts.
  CHECK(count(cli, "trace", "10") == admitted);
  CHECK(count(cli, "model", "10") == 0);
}

TEST_CASE("an end that no execution of the model has is reported by both") {
  const CliFixture cli;
  // Wrong: the box may stick in the hand, but else it lies where it was to be placed.
  open_placing(cli, "Releases(Place(region),BoxIn(region),time).", "RobotIn(region(?p))");
  cli.replace("domain.e", "Terminates(Place(region),Holding(),time).",
              "Releases(Place(region),Holding(),time).");
  const auto model = run(cli, {"--match", "model", "--out", "model"}, 1);
  CHECK(model["verdict"] == "discrepancy");
  bool in_r2 = false;
  for (const auto& fluent : model["discrepancies"][0]["fluents"]) {
    in_r2 = in_r2 || (fluent["fluent"] == "BoxIn(r2)" && fluent["observed"] == true);
  }
  CHECK(in_r2);
  CHECK(run(cli, {"--match", "trace", "--out", "trace"}, 1)["verdict"] == "discrepancy");
}

TEST_CASE("a model that leaves nothing open makes the two rules one") {
  const CliFixture cli;
  CHECK(count(cli, "trace", "6") == count(cli, "model", "6"));
  CHECK(count(cli, "trace", "6") > 0);
}

TEST_CASE("another word than trace or model is refused where it stands") {
  const CliFixture cli;
  CHECK(cli.parallax({"run", "edge.yaml", "--match", "modell"}).code == 2);
  CHECK(cli.parallax({"rates", "edge.yaml", "--match", "modell"}).code == 2);
  cli.replace("edge.yaml", "horizon: 6", "horizon: 6\nmatch: modell");
  const auto result = cli.parallax({"run", "edge.yaml"});
  CHECK(result.code == 3);
  CHECK(result.err.find("edge.yaml:11:8-13: error") != std::string::npos);
  CHECK(result.err.find("`model`") != std::string::npos);
}

/// Duration and length of the first drive of the first simulation.
struct Drive {
  double time_s = 0.0, way_m = 0.0;
};

Drive first_drive(const CliFixture& cli, const std::string& folder) {
  std::istringstream journal(cli.read(folder + "/journal.ndjson"));
  for (std::string line; std::getline(journal, line);) {
    const auto record = Json::parse(line);
    if (!record.contains("observations")) continue;
    const auto& states = record["observations"];
    return {record["outcomes"][0]["sim_time_s"],
            std::abs(states[1]["robot.x"].get<double>() - states[0]["robot.x"].get<double>())};
  }
  FAIL("no simulation");
  return {};
}

TEST_CASE("a number in a designator of the plan changes the simulated motion") {
  const CliFixture cli;
  cli.replace("common.yaml", "Go(region): {controller: going, time_limit_s: 30}",
              "Go(region): {controller: going, acceleration_m_s2: 1, time_limit_s: 60, "
              "from_plan: {target: target, speed: max_speed_m_s}}");
  auto plan = cli.read("fetch.lisp");
  const auto at = plan.find("(type going) (pose ?there)");
  REQUIRE(at != std::string::npos);
  const auto drive = [&](const std::string& speed) {
    auto text = plan;
    cli.write("fetch.lisp", text.insert(at, "(speed " + speed + ") "));
    const auto folder = "run" + speed;
    const auto result =
        cli.parallax({"run", "scenario.yaml", "--max-runs", "1", "--out", folder, "--quiet"});
    CAPTURE(result.err);
    CHECK(result.code == 4);
    return first_drive(cli, folder);
  };
  const auto slow = drive("0.1"), fast = drive("0.25");
  CHECK(slow.way_m == doctest::Approx(fast.way_m).epsilon(0.02));
  CHECK(slow.way_m > 0.25);
  // A trapezoid takes way / speed + speed / acceleration; the time after it is the same for both.
  const double expected_s = slow.way_m * (1 / 0.1 - 1 / 0.25) + (0.1 - 0.25) / 1.0;
  CHECK(slow.time_s - fast.time_s == doctest::Approx(expected_s).epsilon(0.1));
}

TEST_CASE("without its name in from_plan a number of the plan is left alone") {
  const CliFixture cli;
  cli.replace("common.yaml", "Go(region): {controller: going, time_limit_s: 30}",
              "Go(region): {controller: going, time_limit_s: 60, from_plan: {target: target}}");
  const auto drive = [&] {
    cli.parallax({"run", "scenario.yaml", "--max-runs", "1", "--out", "run", "--quiet"});
    const auto found = first_drive(cli, "run");
    std::filesystem::remove_all(cli.folder() / "run");
    return found;
  };
  const auto before = drive();
  cli.replace("fetch.lisp", "(type going) (pose ?there)", "(type going) (speed 0.1) (pose ?there)");
  const auto after = drive();
  CHECK(before.time_s == after.time_s);
  CHECK(before.way_m == after.way_m);
}

}  // namespace
}  // namespace parallax::test
