// `parallax run --second-opinion`: the outcome of a run in another engine, or in another simulator.

#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The built-in simulator of another file of the folder, as a command of somebody else.
std::string simulator_of(const std::string& scenario) {
  return "'" + CliFixture::program() + "' worker " + scenario;
}

/// A world in which no box can be held.
void write_slippery(const CliFixture& cli) {
  cli.write("slippery.yaml",
            "include: scenario.yaml\nname: oil on the pads\nworld: {friction: {box-pad: 0.01}}\n");
}

Json opinion_of(const ProcessResult& ran) { return Json::parse(ran.out)["second_opinion"]; }

TEST_CASE("who is asked about his own run agrees with all of it") {
  const CliFixture cli;
  const auto ran = cli.parallax({"run", "edge.yaml", "--out", "r", "--json", "--second-opinion",
                                 simulator_of("edge.yaml"), "--second-opinion-runs", "4"});
  CAPTURE(ran.err);
  REQUIRE(ran.code == 1);
  const auto opinion = opinion_of(ran);
  const auto report = Json::parse(ran.out);
  REQUIRE(opinion["causes"].size() == 1);
  CHECK(opinion["causes"][0]["doubt"] == "model");
  CHECK(opinion["causes"][0]["both"] == 1);
  CHECK(opinion["causes"][0]["cause"] == report["discrepancies"][0]["cause"]["text"]);
  const auto clean = report["traces"][0]["clean"].get<std::int64_t>();
  CHECK(opinion["clean"]["clean"] == std::min<std::int64_t>(clean, 4));
  CHECK(opinion["clean"]["discrepancies"] == 0);
  CHECK(opinion["clean"]["unanswered"] == 0);
  CHECK(holds(cli.read("r/report.txt"), "both engines disagree with the model"));
  CHECK_FALSE(holds(cli.read("r/report.txt"), "is in doubt"));
  CHECK(holds(cli.read("r/report.txt"), "verdict: discrepancy, confirmed\n"));
  CHECK(Json::parse(cli.read("r/report.json"))["second_opinion"] == opinion);
}

TEST_CASE("who never holds the box agrees with the discrepancies, and with nothing that is clean") {
  const CliFixture cli;
  write_slippery(cli);
  const auto ran = cli.parallax({"run", "scenario.yaml", "--max-runs", "6", "--out", "r", "--json",
                                 "--second-opinion", simulator_of("slippery.yaml"),
                                 "--second-opinion-runs", "5"});
  CAPTURE(ran.err);
  const auto clean = opinion_of(ran)["clean"];
  CHECK(clean["clean"] == 0);
  CHECK(clean["discrepancies"] == 5);
  CHECK(clean["disagreement_below"] == 1.0);
  CHECK(opinion_of(ran)["causes"].empty());
  CHECK(holds(cli.read("r/report.txt"), "5 discrepancies of "));
}

TEST_CASE(
    "where only the run's simulator finds a discrepancy, it is the simulator that is in doubt") {
  const CliFixture cli;
  write_slippery(cli);
  const auto ran = cli.parallax({"run", "slippery.yaml", "--out", "r", "--json", "--second-opinion",
                                 simulator_of("scenario.yaml"), "--second-opinion-runs", "3"});
  CAPTURE(ran.err);
  REQUIRE(ran.code == 1);
  const auto opinion = opinion_of(ran);
  REQUIRE(opinion["causes"].size() == 1);
  CHECK(opinion["causes"][0]["doubt"] == "simulator");
  CHECK(opinion["causes"][0]["only_first"] == 1);
  CHECK(holds(cli.read("r/report.txt"), "verdict: discrepancy in doubt\n"));
  REQUIRE(cli.parallax({"report", "r"}).code == 0);
  CHECK(holds(cli.read("r/report.html"), "<h1>Discrepancy in doubt</h1>"));
  CHECK(holds(cli.read("r/report.html"), "In doubt: ode agrees with the model."));
  CHECK(holds(cli.read("r/report.txt"), "only ode does"));
  CHECK(holds(cli.read("r/report.txt"), "the simulator is in doubt"));
  CHECK_FALSE(holds(cli.read("r/report.txt"), "both engines"));
  CHECK(holds(cli.read("r/report.txt"), "no simulation was clean in ode"));
}

TEST_CASE("the opinion is the same for any number of workers, and the run is as without it") {
  const CliFixture cli;
  const std::vector<std::string> run = {"run",         "edge.yaml",  "--keep-going", "--execution",
                                        "closed-loop", "--max-runs", "12",           "--json"};
  const auto with = [&](std::vector<std::string> more) {
    auto all = run;
    all.insert(all.end(), more.begin(), more.end());
    return Json::parse(without_timing(cli.parallax(all).out));
  };
  write_slippery(cli);
  const auto asked = simulator_of("slippery.yaml");
  auto one = with({"--out", "a", "--second-opinion", asked});
  const auto two = with({"--out", "b", "--jobs", "2", "--second-opinion", asked});
  CHECK(one["second_opinion"] == two["second_opinion"]);
  CHECK(one["second_opinion"]["simulations"].size() == 12);
  auto without = with({"--out", "c"});
  CHECK(cli.read("a/journal.ndjson") == cli.read("c/journal.ndjson"));
  one.erase("second_opinion");
  for (auto* report : {&one, &without}) (*report)["discrepancies"] = nullptr;  // they name folders
  CHECK(one == without);
}

TEST_CASE("the bound is that of Clopper and Pearson, and no answer counts against it") {
  const CliFixture cli;
  // No start is valid there: the robot's place is beyond the rail.
  cli.write("elsewhere.yaml",
            "include: scenario.yaml\nworld: {joints: {drive: {range_m: [-0.01, 0.01]}}}\n");
  const auto ran = cli.parallax({"run", "scenario.yaml", "--max-runs", "4", "--out", "r", "--json",
                                 "--second-opinion", simulator_of("elsewhere.yaml"),
                                 "--second-opinion-runs", "4"});
  CAPTURE(ran.err);
  CHECK(opinion_of(ran)["clean"]["unanswered"] == 4);
  CHECK(opinion_of(ran)["clean"]["disagreement_below"] == 1.0);
  const auto same = cli.parallax({"run", "scenario.yaml", "--max-runs", "4", "--out", "s", "--json",
                                  "--second-opinion", simulator_of("scenario.yaml")});
  const double upper = opinion_of(same)["clean"]["disagreement_below"];
  CHECK(upper == doctest::Approx(1.0 - std::pow(0.05, 1.0 / 4.0)));
}

TEST_CASE("an engine that simulates the scenario already, or a command that is none, is refused") {
  const CliFixture cli;
  const auto same = cli.parallax({"run", "edge.yaml", "--second-opinion", "ode"});
  CHECK(same.code == 2);
  CHECK(holds(same.err, "simulated by this engine already"));
  const auto quote = cli.parallax({"run", "edge.yaml", "--second-opinion", "a 'b"});
  CHECK(quote.code == 2);
  const auto none =
      cli.parallax({"run", "edge.yaml", "--out", "r", "--second-opinion", "./no_such_program"});
  CHECK(none.code != 0);
  CHECK(holds(none.err, "no_such_program"));
  CHECK_FALSE(std::filesystem::exists(cli.folder() / "r" / "journal.ndjson"));
}

/// Is the engine there, as doctor names it?
bool is_there(const CliFixture& cli, const std::string& title) {
  const auto doctor = Json::parse(cli.parallax({"doctor", "--json"}).out);
  for (const auto& check : doctor["checks"]) {
    if (check["name"] == title) return check["health"] == "works";
  }
  return false;
}

void compare_with_ode(const std::string& title, const std::string& name) {
  CAPTURE(name);
  const CliFixture cli;
  const auto ran = cli.parallax({"run", "edge.yaml", "--out", "r", "--json", "--second-opinion",
                                 name, "--second-opinion-runs", "6"});
  CAPTURE(ran.err);
  if (!is_there(cli, title)) {
    CHECK(ran.code == 2);
    CHECK(holds(ran.err, "lib" + name + "-dev"));
    return;
  }
  REQUIRE(ran.code == 1);
  const auto opinion = opinion_of(ran);
  CHECK(opinion["first"].get<std::string>().starts_with("ode "));
  CHECK(opinion["other"].get<std::string>().starts_with(name + " "));
  CHECK(opinion["causes"].size() == 1);
  // The other way round, and the engine is on record: a run made by it is repeated by it.
  cli.write("other.yaml", "include: edge.yaml\nsimulator: {engine: " + name + "}\n");
  const auto back = cli.parallax({"run", "other.yaml", "--out", "s", "--json", "--second-opinion",
                                  "ode", "--second-opinion-runs", "6"});
  CAPTURE(back.err);
  CHECK(Json::parse(back.out)["simulator"]["name"] == name);
  CHECK(opinion_of(back)["other"].get<std::string>().starts_with("ode "));
  CHECK(cli.parallax({"replay", "s"}).code == 0);
  REQUIRE(cli.parallax({"report", "s", "-o", "s.html"}).code == 0);
  CHECK(holds(cli.read("s.html"), "Second opinion"));
  CHECK(holds(cli.read("s.html"), opinion_of(back)["other"].get<std::string>()));
  CHECK(holds(cli.read("s/journal.ndjson"), "\"name\":\"" + name + "\""));
}

TEST_CASE("ode and other engines about the box at the border") {
  compare_with_ode("MuJoCo", "mujoco");
  compare_with_ode("Bullet", "bullet");
}

}  // namespace
}  // namespace parallax::test
