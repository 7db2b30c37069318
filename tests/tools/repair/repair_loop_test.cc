// `parallax repair --loop`: repaired, run again, repaired, in copies.

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/tools/cli_json.h"
#include "tests/tools/two_models.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

const std::string kUnparks = "[drawer,time] Terminates(OpenDrawer(drawer),Parked(),time).\n";
const std::string kReopens = "[drawer,time] Initiates(Park(),Open(drawer),time).\n";
const std::string kParks = "[drawer,time] Initiates(CloseDrawer(drawer),Parked(),time).\n";

/// The model forgets three effects, which show one after the other: no two edits mend all of it.
struct ThreeMistakes : TwoModels {
  ThreeMistakes() { world("load opens.e\n\n" + kUnparks + kParks + kReopens); }
};

TEST_CASE("three mistakes: two rounds, then a clean run with its claim, and one patch") {
  for (const std::string execution : {"open-loop", "closed-loop"}) {
    CAPTURE(execution);
    const ThreeMistakes cli;
    json_of(cli,
            {"run", "two/own.yaml", "--out", "out", "--epsilon", "0.2", "--execution", execution},
            1);
    const auto before = files_below(cli.folder());
    const auto report = json_of(cli, {"repair", "out", "--loop", "--out", "repaired"});
    CAPTURE(report.dump());
    CHECK(report.at("end") == "clean");
    const auto& rounds = report.at("rounds");
    REQUIRE(rounds.size() == 2);
    CHECK(rounds.at(0).at("folder") == "out");
    CHECK(rounds.at(0).at("verdict") == "discrepancy");
    CHECK(rounds.at(1).at("folder") == rounds.at(0).at("next_folder"));
    CHECK(rounds.at(1).at("verdict") == "no-discrepancy");
    // As it was asked for on the command line of the first run.
    const std::string claim = rounds.at(1).at("claims").at(0);
    CHECK(claim.find("99 %") != std::string::npos);
    const auto again = nlohmann::json::parse(cli.read("repaired/run-2/report.json"));
    CHECK(again.at("criterion").at("epsilon") == 0.2);
    CHECK(again.at("execution") == execution);

    // The user's files are as they were; all that is new lies in the folder that was named.
    for (const auto& [path, text] : before) CHECK(cli.read(path) == text);
    for (const auto& [path, text] : files_below(cli.folder())) {
      const bool is_known = std::any_of(before.begin(), before.end(),
                                        [&](const auto& each) { return each.first == path; });
      CHECK((is_known || path.starts_with("repaired/")));
    }
    CHECK(nlohmann::json::parse(cli.read("repaired/rounds.json")).at("rounds") == rounds);
    CHECK(cli.read("repaired/rounds.txt").find("clean: the run after it is clean.") !=
          std::string::npos);
    CHECK(cli.read("repaired/repair.patch") == report.at("patch").get<std::string>());

    // One patch against the originals.
    ProcessOptions here;
    here.folder = cli.folder().string();
    const auto applied = run_process({"git", "apply", "repaired/repair.patch"}, here);
    CHECK_MESSAGE(applied.code == 0, applied.err);
    const auto model = cli.read("two/opens.e");
    CHECK(model.find(kUnparks) != std::string::npos);
    CHECK(cli.read("two/domain.e").find(kParks) != std::string::npos);
    CHECK(cli.read("two/domain.e").find(kReopens) != std::string::npos);
    CHECK(
        json_of(cli, {"run", "two/own.yaml", "--out", "again", "--epsilon", "0.2"}).at("verdict") ==
        "no-discrepancy");
  }
}

TEST_CASE("the rounds are bounded, and --apply writes the user's files at last") {
  const ThreeMistakes cli;
  json_of(cli, {"run", "two/own.yaml", "--out", "out"}, 1);
  const auto report = json_of(cli, {"repair", "out", "--loop", "--out", "one", "--rounds", "1"}, 1);
  CHECK(report.at("end") == "rounds");
  CHECK(report.at("rounds").size() == 1);
  CHECK(cli.read("two/opens.e").find("Parked") == std::string::npos);
  CHECK(cli.parallax({"repair", "out", "--loop", "--out", "all", "--apply", "1"}).code == 0);
  CHECK(cli.read("two/opens.e").find(kUnparks) != std::string::npos);
  CHECK(cli.read("two/domain.e").find(kParks) != std::string::npos);
}

TEST_CASE("a file that the scenario names by an absolute path has no copy, and stays as it is") {
  const ThreeMistakes cli;
  cli.replace("two/own.yaml", "opens.e", (cli.folder() / "two" / "opens.e").string());
  json_of(cli, {"run", "two/own.yaml", "--allow-outside", "--out", "out"}, 1);
  const auto before = cli.read("two/opens.e");
  const auto refused =
      cli.parallax({"repair", "out", "--loop", "--out", "copies", "--allow-outside"});
  CHECK(refused.code == 2);
  CHECK(refused.err.find("was not read from its copy") != std::string::npos);
  CHECK(cli.read("two/opens.e") == before);
}

TEST_CASE("an error in a later round: what was done is on record") {
  const ThreeMistakes cli;
  // The second change is one of a file that is named by an absolute path.
  cli.replace("two/opens.e", "load domain.e",
              "load " + (cli.folder() / "two" / "domain.e").string());
  cli.world("load " + (cli.folder() / "two" / "opens.e").string() + "\n\n" + kUnparks + kParks +
            kReopens);
  json_of(cli, {"run", "two/own.yaml", "--allow-outside", "--out", "out"}, 1);
  const auto failed = cli.parallax(
      {"repair", "out", "--loop", "--out", "fixed", "--allow-outside", "--apply", "1"});
  CAPTURE(failed.out);
  CAPTURE(failed.err);
  CHECK(failed.code == 2);
  CHECK(failed.err.find("was not read from its copy") != std::string::npos);
  CHECK(failed.out.find("failed: an error ended round 2") != std::string::npos);
  CHECK(cli.read("fixed/rounds.txt").find("applied: ") != std::string::npos);
  const auto log = nlohmann::json::parse(cli.read("fixed/rounds.json"));
  CHECK(log.at("end") == "failed");
  CHECK(log.at("rounds").at(0).at("verdict") == "discrepancy");
  CHECK(cli.read("fixed/repair.patch").find(kUnparks) != std::string::npos);
  CHECK(cli.read("two/opens.e").find(kUnparks) == std::string::npos);  // it did not end clean
}

/// A drawer is pulled and pushed; `model.e` is to hold against the world `truth.e` from `start.e`.
void write_drawer_scenario(const CliFixture& cli) {
  cli.write("pull.lisp",
            "(def-cram-function pull ()\n  (perform (an action (type pulling)))\n"
            "  (perform (an action (type pushing))))\n(pull)\n");
  cli.write("robot.bind",
            "action pulling () -> Pull()  ok: Open() | !Open() @t+1 "
            "else manipulation-goal-not-reached\n"
            "action pushing () -> Push()  ok: !Open() @t+1 else manipulation-goal-not-reached\n");
  cli.write("drawer.yaml",
            "model: [model.e, start.e]\nsimulator: {model: truth.e}\nplan: pull.lisp\n"
            "bind: robot.bind\nhorizon: 2\nconstraints: \"Happens(Push(),time-1)\"\n");
}

TEST_CASE("a repair that takes starts from the plan does not end clean") {
  const CliFixture cli;
  cli.write("domain.e",
            "fluent Open()\nfluent Lit()\n\nevent Pull()\nevent Push()\n\n"
            "[time] Terminates(Push(),Open(),time).\n[time] Initiates(Pull(),Open(),time).\n");
  cli.write("model.e", "load domain.e\n");
  cli.write("truth.e", "load domain.e\n\n[time] Happens(Pull(),time) -> HoldsAt(Lit(),time).\n");
  cli.write("start.e", "!HoldsAt(Open(),0).\n");
  write_drawer_scenario(cli);
  json_of(cli, {"run", "drawer.yaml", "--out", "out"}, 1);
  const auto report = json_of(cli, {"repair", "out", "--loop", "--out", "fixed"}, 1);
  CAPTURE(report.dump());
  CHECK(report.at("end") == "plan-at-fault");
  const std::string why = report.at("why");
  CHECK(why.find("from 1 of 2 initial states the constraints can no longer be reached") !=
        std::string::npos);
  CHECK(report.at("rounds").at(0).at("verdict") == "no-discrepancy");
  CHECK(report.at("rounds").at(0).at("traces_lost") == 1);
}

TEST_CASE("it ends at a tie, with a clean folder, and where there is no room for it") {
  // The drawer opens only in the light, and the lamp burns if and only if the arm is parked.
  const CliFixture cli;
  const std::string domain =
      "fluent Open()\nfluent Lit()\nfluent Parked()\n\nevent Pull()\nevent Push()\n\n"
      "[time] Terminates(Push(),Open(),time).\n";
  const std::string model = domain + "[time] Initiates(Pull(),Open(),time).\n";
  cli.write("model.e", model);
  cli.write("truth.e", domain + "[time] HoldsAt(Lit(),time) -> Initiates(Pull(),Open(),time).\n");
  cli.write("start.e", "!HoldsAt(Open(),0).\nHoldsAt(Lit(),0) <-> HoldsAt(Parked(),0).\n");
  write_drawer_scenario(cli);
  json_of(cli, {"run", "drawer.yaml", "--out", "out"}, 1);
  const auto alone = json_of(cli, {"repair", "out", "--limit", "0"}, 1);
  CAPTURE(alone.dump());
  REQUIRE(alone.at("tied") == 2);
  const auto tie = cli.parallax({"repair", "out", "--loop", "--out", "tie", "--apply", "1"});
  CAPTURE(tie.out);
  CAPTURE(tie.err);
  CHECK(tie.code == 1);
  CHECK(tie.out.find("tie: ") != std::string::npos);
  CHECK(tie.out.find("only if `HoldsAt(Lit(),time)`") != std::string::npos);
  CHECK(tie.out.find("only if `HoldsAt(Parked(),time)`") != std::string::npos);
  CHECK(cli.read("model.e") == model);

  const auto again = cli.parallax({"repair", "out", "--loop", "--out", "tie"});
  CHECK(again.code == 2);
  CHECK(again.err.find("needs a folder that is new or empty") != std::string::npos);
  CHECK(cli.parallax({"repair", "out", "--loop"}).code == 2);
  CHECK(cli.parallax({"repair", "out", "--out", "there"}).code == 2);

  cli.write("truth.e", model);
  json_of(cli, {"run", "drawer.yaml", "--out", "clean", "--epsilon", "0.5"});
  const auto clean = json_of(cli, {"repair", "clean", "--loop", "--out", "nothing"});
  CHECK(clean.at("end") == "nothing-to-repair");
  CHECK(clean.at("patch") == "");
}

/// In the dark the drawer may be stuck, and pushing puts out the light: the model knows neither.
void write_dark_drawer(const CliFixture& cli) {
  cli.write("domain.e",
            "fluent Open()\nfluent Lit()\n\nevent Pull()\nevent Push()\nevent Wave()\n\n"
            "[time] Terminates(Push(),Open(),time).\n");
  const std::string pull = "[time] Initiates(Pull(),Open(),time).\n";
  cli.write("model.e", "load domain.e\n\n" + pull);
  cli.write("truth.e",
            "load domain.e\n\nfluent Stuck()\nnoninertial Stuck\n\n" + pull +
                "[time] Happens(Pull(),time) -> HoldsAt(Lit(),time) | !HoldsAt(Stuck(),time).\n"
                "[time] HoldsAt(Lit(),time) -> Terminates(Push(),Lit(),time).\n");
  cli.write("start.e", "!HoldsAt(Open(),0).\n");
  write_drawer_scenario(cli);
  cli.write("robot.bind",
            "action pulling () -> Pull()  ok: Open() @t+1 else manipulation-goal-not-reached\n"
            "action pushing () -> Push()  ok: !Open() @t+1 else manipulation-goal-not-reached\n"
            "action waving () -> Wave()  ok: !Open() @t+1 else manipulation-goal-not-reached\n"
            "query lit () ok: Lit() @t\n");
}

TEST_CASE("what a precaution takes to fail is asked of no later round") {
  // In the light the plan waves first, so that what it shows is a trace of its own: the run ends
  // with the discrepancy of the shorter one.
  const CliFixture cli;
  write_dark_drawer(cli);
  cli.replace("pull.lisp", "  (perform (an action (type pulling)))",
              "  (when (holds '(lit)) (perform (an action (type waving))))\n"
              "  (perform (an action (type pulling)))");
  cli.replace("drawer.yaml", "horizon: 2", "horizon: 3");
  // It fails more often than it goes well: else the unchanged model would agree with more runs.
  cli.replace("truth.e", "noninertial Stuck\n",
              "noninertial Stuck\nfluent Jammed()\nnoninertial Jammed\n"
              "[time] Happens(Pull(),time) -> HoldsAt(Lit(),time) | !HoldsAt(Jammed(),time).\n");
  json_of(cli, {"run", "drawer.yaml", "--out", "out"}, 1);
  json_of(cli, {"explain", "out"}, 1);  // from the same start it goes well and fails
  const auto report = json_of(cli, {"repair", "out", "--loop", "--out", "fixed"}, 1);
  CAPTURE(report.dump(1));
  const auto& rounds = report.at("rounds");
  REQUIRE(rounds.size() == 2);
  CHECK(rounds.at(0).at("words") == "`Pull()` can happen only if `HoldsAt(Lit(),time)`");
  CHECK(rounds.at(0).at("failed") < rounds.at(0).at("runs"));
  CHECK(rounds.at(0).at("verdict") == "discrepancy");
  // The runs in which the drawer opened in the dark do not stand in its way.
  CHECK(rounds.at(1).at("words") == "an effect is missing: `Terminates(Push(),Lit(),time)`");
  CHECK(rounds.at(1).at("verdict") == "no-discrepancy");
  // From the dark the plan has no execution any more.
  CHECK(report.at("end") == "plan-at-fault");
  CHECK(report.at("why").get<std::string>().find("from 1 of 2 initial states") !=
        std::string::npos);
}

TEST_CASE("the mistakes that show from several initial states are repaired in one round") {
  const CliFixture cli;
  write_dark_drawer(cli);
  json_of(cli, {"run", "drawer.yaml", "--out", "out"}, 1);
  json_of(cli, {"explain", "out"}, 1);
  const auto report = json_of(cli, {"repair", "out", "--loop", "--out", "fixed"}, 1);
  CAPTURE(report.dump(1));
  REQUIRE(report.at("rounds").size() == 1);
  CHECK(report.at("rounds").at(0).at("words") ==
        "`Pull()` can happen only if `HoldsAt(Lit(),time)`; and an effect is missing: "
        "`Terminates(Push(),Lit(),time)`");
  CHECK(report.at("rounds").at(0).at("verdict") == "no-discrepancy");
  CHECK(report.at("end") == "plan-at-fault");
}

TEST_CASE("rounds in physics") {
  // The model of two regions that forgets where the box must be to be picked up.
  const CliFixture cli;
  json_of(cli, {"run", "wrong_model.yaml", "--out", "out"}, 1);
  const auto before = files_below(cli.folder());
  const auto wrong = json_of(cli, {"repair", "out", "--loop", "--out", "fixed"}, 1);
  CAPTURE(wrong.dump(1));
  // The plan picks up a thing out of reach: a model that forbids this leaves nothing to run.
  CHECK(wrong.at("end") == "plan-at-fault");
  CHECK(wrong.at("rounds").at(0).at("failed") > 0);
  for (const auto& [path, text] : before) CHECK(cli.read(path) == text);
}

}  // namespace
}  // namespace parallax::test
