// `parallax learn` in worlds that are models. `parallax diff`, which shares nothing with it,
// compares the learned models with these.

#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/tools/cli_json.h"
#include "tests/tools/two_models.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Learned for `scenario` in the folder OUT: the traces of `truth`, a scenario, and no others?
void check_same_traces(const CliFixture& cli, const std::string& truth, const std::string& out) {
  const auto result =
      cli.parallax({"diff", truth, out + "/learned.yaml", "--json", "--allow-outside"});
  REQUIRE(Json::accept(result.out));
  const auto traces = Json::parse(result.out).at("traces");
  CAPTURE(cli.read(out + "/learned.e"));
  CHECK(traces.at("lost").at("answer") == "none");
  CHECK(traces.at("gained").at("answer") == "none");
}

/// The two regions without physics: the model of the folder is the world.
std::string regions_world(const CliFixture& cli, const std::string& model) {
  cli.write("own.yaml",
            "plan: fetch.lisp\nbind: robot.bind\nhorizon: 6\n"
            "regions:\n  cells:\n    r1: {x: [0, 1]}\n    r2: {x: [1, 2]}\n"
            "constraints:\n  - \"{region} (Happens(Place(region),time-1) & "
            "HoldsAt(BoxIn(region),time))\"\n"
            "simulator: {model: domain.e}\nmodel: " +
                model + "\n");
  return "own.yaml";
}

TEST_CASE("the drawer's model is learned from its declarations; every axiom names its runs") {
  const TwoModels cli;
  const auto before = files_below(cli.folder() / "two");
  const auto report = json_of(cli, {"learn", "two/unparks.yaml", "--out", "out"});
  CHECK(files_below(cli.folder() / "two") == before);
  CHECK(report.at("clean") == true);
  CHECK(report.at("why") == "");
  CHECK(report.at("runs") == report.at("runs_admitted"));
  CHECK(report.at("claims").size() == 1);
  const auto model = report.at("model").get<std::string>();
  CHECK(model == cli.read("out/learned.e"));
  // Also facts that the scenario's own model lacks: its axioms are not looked at.
  CHECK(model.find("Terminates(OpenDrawer(drawer),Parked(),time).\n; Taught by run") !=
        std::string::npos);
  cli.write("two/truth.yaml", "include: unparks.yaml\nmodel: [unparks.e, start.e]\n");
  check_same_traces(cli, "two/truth.yaml", "out");
  CHECK(cli.parallax({"check", "out/learned.e", "--horizon", "3"}).code == 0);
  CHECK(cli.parallax({"fmt", "--check", "out/learned.e"}).code == 0);
  CHECK(cli.parallax({"run", "out/learned.yaml", "--allow-outside", "--out", "again"}).code == 0);
  // A round is a run like any other.
  CHECK(cli.parallax({"replay", "out/rounds/1/run", "--allow-outside"}).code == 0);
}

TEST_CASE("the model's own axioms about events do not count, nor do jobs") {
  const TwoModels cli;
  const auto first = json_of(cli, {"learn", "two/agree.yaml", "--out", "a", "--seed", "7"});
  cli.write("two/bare.e",
            "sort drawer\ndrawer top\nfluent Open(drawer)\nfluent Parked()\n"
            "event OpenDrawer(drawer)\nevent CloseDrawer(drawer)\nevent Park()\nevent Reach()\n");
  cli.replace("two/agree.yaml", "model: [opens.e, start.e]", "model: [bare.e, start.e]");
  const auto second =
      json_of(cli, {"learn", "two/agree.yaml", "--out", "b", "--seed", "7", "--jobs", "2"});
  CHECK(first.at("model") == second.at("model"));
  CHECK(first.at("rounds") == second.at("rounds"));
  CHECK(first.at("dropped") == 4);
  CHECK(second.at("dropped") == 0);
}

TEST_CASE("two regions: the traces of the plan are those of the true model") {
  const CliFixture cli;
  const auto scenario = regions_world(cli, "[domain.e, start.e]");
  const auto report = json_of(cli, {"learn", scenario, "--out", "out"});
  CHECK(report.at("clean") == true);
  check_same_traces(cli, scenario, "out");
}

TEST_CASE("with random sequences the conditions come, and other plans go as in the world, too") {
  const CliFixture cli;
  const auto scenario = regions_world(cli, "[domain.e, start.e]");
  const auto report = json_of(cli, {"learn", scenario, "--explore", "60", "--out", "out"});
  CHECK(report.at("clean") == true);
  CHECK(report.at("sequences") == 60);
  CHECK(report.at("sequences_clean").get<int>() >= 20);
  CHECK(report.at("runs") == report.at("runs_admitted"));
  check_same_traces(cli, scenario, "out");
  // Without a plan: everything that the robot can do, one thing at a time.
  const std::string one =
      "[event1,event2,time] Happens(event1,time) & Happens(event2,time) -> event1=event2.\n";
  cli.write("truth.e", cli.read("domain.e") + cli.read("start.e") + one);
  cli.write("learned.e", cli.read("out/learned.e") + one);
  const auto diff = cli.parallax({"diff", "truth.e", "learned.e", "--horizon", "5", "--json"});
  REQUIRE(Json::accept(diff.out));
  const auto traces = Json::parse(diff.out).at("traces");
  CHECK(traces.at("lost").at("answer") == "none");
  CHECK(traces.at("gained").at("answer") == "none");
}

TEST_CASE("random sequences on record are repeated by replay, and are no runs of the plan") {
  const CliFixture cli;
  const auto scenario = regions_world(cli, "[domain.e, start.e]");
  cli.write("a \"b\".yaml", "include: " + scenario + "\n");
  json_of(cli, {"learn", "a \"b\".yaml", "--explore", "12", "--out", "out"});
  int repeated = 0;
  for (const auto& round : fs::directory_iterator(cli.folder() / "out" / "rounds")) {
    const auto run = fs::relative(round.path() / "run", cli.folder()).string();
    if (!fs::exists(cli.folder() / run / "journal.ndjson")) continue;
    if (cli.read(run + "/journal.ndjson").find("\"random_sequences\":true") == std::string::npos) {
      continue;
    }
    ++repeated;
    const auto again = cli.parallax({"replay", run, "--allow-outside"});
    CAPTURE(again.err);
    CHECK(again.code == 0);
    CHECK(again.out.find("identical") != std::string::npos);
    for (const std::string command : {"repair", "coverage"}) {
      const auto refused = cli.parallax({command, run, "--allow-outside"});
      CHECK(refused.code == 3);
      CHECK(refused.err.find("random sequences of events") != std::string::npos);
    }
  }
  CHECK(repeated > 0);
}

TEST_CASE("the warehouse: the traces of the plan are those of the true model") {
  const CliFixture cli;
  fs::copy(fs::path(PARALLAX_SOURCE_DIR) / "scenarios" / "warehouse", cli.folder() / "store");
  const auto task = cli.read("store/task.yaml");
  cli.write("store/own.yaml",
            task.substr(0, task.find("\nmapping:") + 1) + "simulator: {model: domain.e}\n");
  const auto report = json_of(cli, {"learn", "store/own.yaml", "--explore", "40", "--out", "out"});
  CHECK(report.at("clean") == true);
  CHECK(report.at("runs") == report.at("runs_admitted"));
  check_same_traces(cli, "store/own.yaml", "out");
}

TEST_CASE("an outcome that is open is left open, and two runs are named that say so") {
  const TwoModels cli;
  cli.write("two/loop.yaml", "include: sticks.yaml\nexecution: closed-loop\nexpect:\n");
  const auto report = json_of(cli, {"learn", "two/loop.yaml", "--out", "out"});
  CHECK(report.at("clean") == true);
  CHECK(report.at("model").get<std::string>().find(
            "Releases(OpenDrawer(drawer),Open(drawer),time)") != std::string::npos);
  REQUIRE(report.at("contradictions").size() == 1);
  CHECK(report.at("contradictions").at(0).get<std::string>().find("OpenDrawer(top)") !=
        std::string::npos);
}

TEST_CASE(
    "a world that refuses everything: no effect is learned, and why it is not clean is said") {
  const TwoModels cli;
  const auto scenario = cli.world(
      "load domain.e\n[drawer,time] !Happens(OpenDrawer(drawer),time).\n"
      "[drawer,time] !Happens(CloseDrawer(drawer),time).\n[time] !Happens(Park(),time).\n"
      "[time] !Happens(Reach(),time).\n");
  const auto report = json_of(cli, {"learn", scenario, "--out", "out"}, 4);
  CHECK(report.at("clean") == false);
  CHECK(report.at("why") == "no trace of the learned model reaches the scenario's constraints");
  CHECK(report.at("axioms") == 0);
  CHECK(report.at("claims").empty());
  // In random sequences the rules say that the events cannot happen: nobody's plan depends on it.
  const auto explored =
      json_of(cli, {"learn", scenario, "--explore", "20", "--out", "explored"}, 4);
  CHECK(explored.at("runs") == explored.at("runs_admitted"));
}

TEST_CASE(
    "what the scenario does not observe, and what never happened, is said not to be learned") {
  const TwoModels cli;
  cli.write("two/lit.e", "load opens.e\nfluent Lit()\n[time] Initiates(Reach(),Lit(),time).\n");
  cli.write("two/blind.yaml",
            "include: agree.yaml\nmodel: [lit.e, start.e]\nmapping: {Lit(): ignored}\nexpect:\n");
  const auto report = json_of(cli, {"learn", "two/blind.yaml", "--out", "out"});
  const auto not_learned = report.at("not_learned").dump();
  CHECK(not_learned.find("Lit: the scenario does not observe it") != std::string::npos);
  CHECK(not_learned.find("Reach: it never happened") != std::string::npos);
  CHECK(not_learned.find("Park:") == std::string::npos);
}

TEST_CASE("of an event that the model demands it is not said that it never happened") {
  const TwoModels cli;
  cli.write("two/lit.e",
            "load opens.e\nfluent Lit()\n[time] HoldsAt(Lit(),time) -> Happens(Reach(),time).\n");
  cli.write("two/blind.yaml",
            "include: agree.yaml\nmodel: [lit.e, start.e]\nmapping: {Lit(): ignored}\nexpect:\n");
  const auto report = json_of(cli, {"learn", "two/blind.yaml", "--out", "out"});
  const auto not_learned = report.at("not_learned").dump();
  CHECK(not_learned.find("Reach: the scenario's model demands it") != std::string::npos);
  CHECK(not_learned.find("it never happened") == std::string::npos);
}

TEST_CASE("a budget that is used up: the best model so far, and exit code 4") {
  const TwoModels cli;
  const auto result = cli.parallax({"learn", "two/agree.yaml", "--out", "out", "--max-runs", "3"});
  CHECK(result.code == 4);
  CHECK(result.out.find("Initiates(OpenDrawer(drawer),Open(drawer),time)") != std::string::npos);
  CHECK(result.err.find("the budget of 3 simulations is used up") != std::string::npos);
  CHECK(cli.read("out/learned.e") == result.out);
}

TEST_CASE("bad input: no plan, a folder with rounds, a scenario that is none") {
  const TwoModels cli;
  CHECK(cli.parallax({"learn", "missing.yaml"}).code == 2);
  CHECK(cli.parallax({"learn", "two/opens.e"}).code != 0);
  cli.write("two/planless.yaml",
            "horizon: 3\nmodel: [opens.e, start.e]\nsimulator: {model: opens.e}\n"
            "constraints: \"Happens(Park(),time-1)\"\n");
  const auto planless = cli.parallax({"learn", "two/planless.yaml", "--out", "out"});
  CHECK(planless.code == 3);
  CHECK(planless.err.find("plan") != std::string::npos);
  json_of(cli, {"learn", "two/agree.yaml", "--out", "out"});
  const auto again = cli.parallax({"learn", "two/agree.yaml", "--out", "out"});
  CHECK(again.code == 2);
  CHECK(again.err.find("name another folder") != std::string::npos);
}

TEST_CASE("what is there already is not replaced, and that is said before anything is simulated") {
  const TwoModels cli;
  std::filesystem::create_directory(cli.folder() / "mine");
  cli.write("mine/log.txt", "mine");
  CHECK(cli.parallax({"learn", "two/agree.yaml", "--out", "mine"}).code == 2);
  CHECK(cli.read("mine/log.txt") == "mine");
  const auto model = cli.read("two/opens.e");
  const auto refused =
      cli.parallax({"learn", "two/agree.yaml", "--out", "out", "-o", "two/opens.e"});
  CHECK(refused.code == 2);
  CHECK(refused.err.find("E0011") != std::string::npos);
  CHECK(refused.err.find("round 1") == std::string::npos);
  CHECK(cli.read("two/opens.e") == model);
}

}  // namespace
}  // namespace parallax::test
