// A world that is a model: two models played against each other, with answers known beforehand.

#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"
#include "tests/tools/kitchen_copy.h"
#include "tests/tools/two_models.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

TEST_CASE("two models that agree: clean, with the claim, and the same bytes for any jobs") {
  const TwoModels cli;
  const auto report = json_of(cli, {"run", "two/agree.yaml", "--out", "one"});
  CHECK(report.at("verdict") == "no-discrepancy");
  CHECK(report.at("exploration") == "all traces explored");
  const auto& trace = report.at("traces").at(0);
  CHECK(trace.at("events") == Json({"OpenDrawer(top)", "CloseDrawer(top)", "Park()"}));
  CHECK(trace.at("certified").at("epsilon") <= 0.05);
  CHECK(trace.at("strayed") == 0);
  // The start is given by its state; its variables are the same once more.
  CHECK(cli.read("one/report.txt").find("start region") == std::string::npos);
  CHECK(
      json_of(cli, {"run", "two/agree.yaml", "--out", "three", "--jobs", "3"}).at("simulations") ==
      report.at("simulations"));
  CHECK(cli.read("one/journal.ndjson") == cli.read("three/journal.ndjson"));
  CHECK(cli.parallax({"replay", "one", "--sample", "1.7"}).code == 0);
  CHECK(cli.parallax({"check", "two/agree.yaml"}).code == 0);

  // A run that was ended half-way gives the same.
  const auto journal = cli.read("one/journal.ndjson");
  fs::create_directory(cli.folder() / "half");
  cli.write("half/journal.ndjson", journal.substr(0, journal.find('\n', journal.size() / 2) + 1));
  CHECK(json_of(cli, {"run", "two/agree.yaml", "--out", "half", "--resume"}).at("verdict") ==
        "no-discrepancy");
  CHECK(cli.read("half/journal.ndjson") == journal);
}

TEST_CASE("the folder as a suite: each scenario gives what it expects") {
  const TwoModels cli;
  const auto suite = cli.parallax({"suite", "two"});
  CHECK_MESSAGE(suite.code == 0, suite.out);
  CHECK(suite.out.find("3 passed, 0 failed\n") != std::string::npos);
}

TEST_CASE("an action that the world forbids and that changes nothing compared is told") {
  const TwoModels cli;
  const auto forbids =
      cli.world("load opens.e\n[time] Happens(Park(),time) -> !HoldsAt(Parked(),time).\n");
  const auto report = json_of(cli, {"run", forbids, "--out", "out"});
  CHECK(report.at("verdict") == "no-discrepancy");
  const std::string told = "event 2, Park(), failed in 90 of 90 clean runs";
  CHECK(report.at("traces").at(0).at("caveats").dump().find(told) != std::string::npos);
  CHECK(cli.read("out/report.txt").find("not-possible") != std::string::npos);
}

TEST_CASE("an effect that the model forgets is found in the first run, where it happens") {
  const TwoModels cli;
  const auto report = json_of(cli, {"run", "two/unparks.yaml", "--out", "out"}, 1);
  CHECK(report.at("simulations") == 1);
  const auto& found = report.at("discrepancies").at(0);
  CHECK(found.at("kind") == "transient");
  CHECK(found.at("first_divergence") == 1);
  const Json forgotten = {
      {"fluent", "Parked()"}, {"timepoint", 1}, {"predicted", true}, {"observed", false}};
  CHECK(found.at("first") == Json::array({forgotten}));
  CHECK(found.at("cause").at("text") == "OpenDrawer(top): not Parked()");
  CHECK(cli.read("out/report.txt").find("OpenDrawer(top) (two/open_and_close.lisp:4)") !=
        std::string::npos);
  CHECK(cli.parallax({"replay", "out"}).code == 0);
  const auto why = cli.parallax({"explain", "out"});
  CHECK(why.code == 1);
  CHECK(why.out.find("inertia of Parked()") != std::string::npos);
  // A fluent that is ignored is not compared.
  cli.write("two/rest.yaml", "include: unparks.yaml\nmapping: {Parked(): ignored}\nexpect:\n");
  CHECK(json_of(cli, {"run", "two/rest.yaml", "--epsilon", "0.3"}).at("verdict") ==
        "no-discrepancy");
}

TEST_CASE("an outcome that the world leaves open comes out as often as it should") {
  const TwoModels cli;
  const auto half = [&](const std::string& scenario) {
    const auto rates = json_of(cli, {"rates", scenario, "--runs", "1000", "--seed", "3"});
    const auto count = rates.at("traces").at(0).at("any").at("count").get<int>();
    // Binomial(1000, 1/2): beyond 415..585 with probability below 1e-7.
    CHECK(count >= 415);
    CHECK(count <= 585);
    CHECK(json_of(cli, {"rates", scenario, "--runs", "1000", "--seed", "3", "--jobs", "2"})
              .at("traces") == rates.at("traces"));
  };
  half("two/sticks.yaml");
  half(cli.world("load domain.e\n[drawer,time] Releases(OpenDrawer(drawer),Open(drawer),time).\n"));
}

TEST_CASE("an action that the world forbids fails with its reason") {
  const TwoModels cli;
  const auto scenario = cli.world(
      "load opens.e\nfluent Locked()\nHoldsAt(Locked(),0).\n"
      "[drawer,time] Happens(OpenDrawer(drawer),time) -> !HoldsAt(Locked(),time).\n");
  const auto report = json_of(cli, {"run", scenario, "--out", "out"}, 1);
  CHECK(report.at("simulations") == 1);
  const auto& found = report.at("discrepancies").at(0);
  CHECK(found.at("cause").at("text") == "OpenDrawer(top): not-possible");
  CHECK(found.at("first_divergence") == 1);
}

TEST_CASE("the plan's poses lie in regions, whatever the world is") {
  const TwoModels cli;
  const std::string common =
      "plan: fetch.lisp\nbind: robot.bind\nhorizon: 6\nsimulator: {model: domain.e}\n"
      "regions: {cells: {r1: {x: [0, 1]}, r2: {x: [1, 2]}}}\n"
      "constraints: \"{region} Happens(Place(region),time-1)\"\n";
  cli.write("right.yaml", "model: [domain.e, start.e]\n" + common);
  CHECK(json_of(cli, {"run", "right.yaml", "--epsilon", "0.3", "--out", "r"}).at("verdict") ==
        "no-discrepancy");
  // The mistake that physics shows in wrong_model.yaml.
  cli.write("wrong.yaml",
            "include: right.yaml\nmodel: [wrong_domain.e, start.e]\nplan: hasty.lisp\n");
  const auto report = json_of(cli, {"run", "wrong.yaml", "--out", "w"}, 1);
  CHECK(report.at("simulations") == 1);
  CHECK(report.at("discrepancies").at(0).at("first_divergence") == 1);
}

TEST_CASE("the kitchen's model is right about a world that is the kitchen's model") {
  const KitchenCopy cli;
  // Without the mapping of the words to physics.
  const auto common = cli.read("kitchen/household.yaml");
  cli.write("kitchen/household.yaml", common.substr(0, common.find("\nmapping:") + 1));
  for (const std::string plan : {"plan1", "plan3"}) {
    cli.write("kitchen/own.yaml",
              "include: " + plan + ".yaml\nsimulator: {model: domain.e}\nexpect:\n");
    const auto report =
        json_of(cli, {"run", "kitchen/own.yaml", "--epsilon", "0.4", "--out", plan});
    CHECK(report.at("verdict") == "no-discrepancy");
    CHECK(report.at("iterations") == 3);
  }
}

TEST_CASE("names: what the world lacks is not compared, or stands for something else") {
  const TwoModels cli;
  const std::string other =
      "fluent Ajar()\nfluent Parked()\nevent Pull()\nevent Push()\nevent Park()\nevent Reach()\n"
      "[time] Initiates(Pull(),Ajar(),time).\n[time] Terminates(Push(),Ajar(),time).\n"
      "[time] Initiates(Park(),Parked(),time).\n";
  auto scenario = cli.world(
      other,
      "actions:\n  OpenDrawer(d): {controller: Pull()}\n  CloseDrawer(d): {controller: Push()}\n");
  auto report = json_of(cli, {"run", scenario, "--epsilon", "0.3", "--out", "left"});
  CHECK(report.at("verdict") == "no-discrepancy");
  CHECK(cli.read("left/report.txt")
            .find("not compared Open(..): the model of the simulator has no such fluent") !=
        std::string::npos);
  scenario = cli.world(other,
                       "mapping: {Open(d): {flag: Ajar()}}\n"
                       "actions:\n  OpenDrawer(d): {controller: Pull()}\n"
                       "  CloseDrawer(d): {controller: Pull()}\n");
  report = json_of(cli, {"run", scenario, "--epsilon", "0.3", "--out", "right"}, 1);
  CHECK(report.at("discrepancies").at(0).at("first_divergence") == 2);
}

TEST_CASE("what is wrong with the world is said at its place, by check and by run") {
  const TwoModels cli;
  const auto refused = [&](const std::string& scenario, const std::string& code,
                           const std::string& place) {
    for (const std::string command : {"run", "check"}) {
      const auto result = cli.parallax({command, scenario});
      CAPTURE(result.err);
      CHECK(result.code == 3);
      CHECK(result.err.find("error[" + code + "]") != std::string::npos);
      CHECK(result.err.find(place) != std::string::npos);
    }
  };
  const std::string whole = "load opens.e\n";
  cli.write("two/none.yaml",
            "include: common.yaml\nsimulator: {model: nowhere.e}\nmodel: start.e\n");
  refused("two/none.yaml", "E0001", "two/none.yaml:2:20-28");
  cli.write("outside.e", whole);
  cli.write("two/out.yaml",
            "include: common.yaml\nsimulator: {model: ../outside.e}\nmodel: start.e\n");
  refused("two/out.yaml", "E1016", "two/out.yaml:2:20-31");
  cli.write("two/both.yaml",
            "include: common.yaml\nsimulator: {model: opens.e, command: [a]}\nmodel: start.e\n");
  refused("two/both.yaml", "E5102", "two/both.yaml:2:29-35");
  refused(cli.world(whole + "fluent\n"), "E1007", "two/world.e:2");
  refused(cli.world("fluent Parked()\nevent Park()\n"), "E5135", "two/own.yaml:2");
  refused(cli.world(whole, "actions: {Park(): {controller: Parkk()}}\n"), "E5120",
          "two/own.yaml:3:11-16");
  refused(cli.world(whole, "mapping: {Parked(): {flag: Parkd()}}\n"), "E5115",
          "two/own.yaml:3:11-18");
  refused(cli.world(whole, "sampling: {variables: {Parkd(): 1}}\n"), "E5115", "two/own.yaml:3");
  refused(cli.world(whole + "HoldsAt(Parked(),0).\n!HoldsAt(Parked(),0).\n"), "E5134",
          "two/world.e:3");
  refused(cli.world(whole + "HoldsAt(Parked(),2).\n!HoldsAt(Parked(),2).\n"), "E5134",
          "it has no execution of 3 steps");
  refused(cli.world(whole + "completion Happens\n"), "E5134", "two/world.e:2:1");
  refused(cli.world(whole + "[time] HoldsAt(Parked(),time) -> HoldsAt(Open(top),time+2).\n"),
          "E5134", "more than two neighbouring timepoints");
  refused(cli.world(whole + "!HoldsAt(Parked(),0).\n"), "E7105", "two/own.yaml:2");
  refused(cli.world(whole + "[time] Happens(Park(),time) -> Happens(Reach(),time+1).\n"), "E5134",
          "Happens(Reach(),time+1)` ties the events of one timepoint to those of the next");
  refused(
      cli.world(whole + "predicate Late()\nLate() -> HoldsAt(Parked(),3).\n"
                        "!Late() -> HoldsAt(Parked(),0).\n"),
      "E5134",
      "`Late() -> HoldsAt(Parked(),3)` and `!Late() -> HoldsAt(Parked(),0)` are tied together by "
      "`Late()`");
  refused(cli.world(whole,
                    "mapping: {Open(d): {range: \"Open({d})\", holds: [1, 2], fails: [-1, 0]}}\n"),
          "E5107", "two/own.yaml:3:11-17");
  refused(cli.world(whole, "mapping: {Parked(): {equals: \"Parked()\", text: yes}}\n"), "E5107",
          "two/own.yaml:3:11-18");
  refused(cli.world(whole, "actions: {Park(): {controller: Park(), force_n: 3}}\n"), "E5121",
          "two/own.yaml:3:49");
  // 2^13 initial states fit the mapping of the start.
  std::string open_fluents = whole;
  for (int i = 0; i < 13; ++i) open_fluents += "fluent Open" + std::to_string(i) + "()\n";
  refused(cli.world(open_fluents), "E7109", "more than 4096 initial states");
}

TEST_CASE("two scenarios that differ in their worlds alone differ") {
  const TwoModels cli;
  const auto diff = cli.parallax({"diff", "two/agree.yaml", "two/unparks.yaml"});
  CHECK(diff.code == 1);
  CHECK(diff.out.find("world: [drawer,time] Terminates(OpenDrawer(drawer),Parked(),time)") !=
        std::string::npos);
  CHECK(cli.parallax({"diff", "two/agree.yaml", "two/agree.yaml"}).code == 0);
}

TEST_CASE("a mistake in `simulator` is told alone") {
  const TwoModels cli;
  cli.write("two/wrong.yaml",
            "model: [opens.e, start.e]\nplan: open_and_close.lisp\nbind: robot.bind\nhorizon: 3\n"
            "simulator: {modle: opens.e}\n");
  const auto result = cli.parallax({"check", "two/wrong.yaml"});
  CHECK(result.code == 3);
  CHECK(result.err.find("two/wrong.yaml:5:13-17: error[E5102]") != std::string::npos);
  CHECK(result.err.find("error[") == result.err.rfind("error["));
}

TEST_CASE("a link out of the folder is refused alike, whether it leads to a file or not") {
  const TwoModels cli;
  cli.write("outside.e", "load opens.e\n");
  cli.write("two/own.yaml",
            "include: common.yaml\nsimulator: {model: link.e}\nmodel: [opens.e, start.e]\n");
  for (const std::string target : {"../outside.e", "../nowhere.e", "../nowhere/at/all.e"}) {
    fs::remove(cli.folder() / "two/link.e");
    fs::create_symlink(target, cli.folder() / "two/link.e");
    const auto result = cli.parallax({"check", "two/own.yaml"});
    CHECK(result.code == 3);
    CHECK(result.err.find("E1016") != std::string::npos);
    CHECK(result.err.find("E0001") == std::string::npos);
  }
  // Also where the link is a folder on the way.
  fs::create_directory_symlink("../nowhere", cli.folder() / "two/elsewhere");
  cli.replace("two/own.yaml", "link.e", "elsewhere/link.e");
  CHECK(cli.parallax({"check", "two/own.yaml"}).err.find("E1016") != std::string::npos);
  // A link that stays inside is reported to lead nowhere.
  fs::remove(cli.folder() / "two/link.e");
  fs::create_symlink("nothing.e", cli.folder() / "two/link.e");
  cli.replace("two/own.yaml", "elsewhere/link.e", "link.e");
  CHECK(cli.parallax({"check", "two/own.yaml"}).err.find("E0001") != std::string::npos);
}

TEST_CASE("who forgets the world, or what holds there at first, is told what a model needs") {
  const TwoModels cli;
  cli.write("two/none.yaml", "include: common.yaml\nmodel: [opens.e, start.e]\n");
  const auto none = cli.parallax({"run", "two/none.yaml"});
  CHECK(none.code == 3);
  CHECK(none.err.find("`simulator: {model: FILE}` names it") != std::string::npos);
  const auto start =
      cli.parallax({"run", cli.world("load opens.e\n\n[drawer] HoldsAt(Open(drawer),0).\n")});
  CHECK(start.code == 3);
  CHECK(start.err.find("what it says of timepoint 0 has to admit the starts") != std::string::npos);
}

}  // namespace
}  // namespace parallax::test
