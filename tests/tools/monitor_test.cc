// A log compared with model and plan, by the program: files, pipes, run folders, bad input.

#include <doctest/doctest.h>
#include <sys/stat.h>

#include <fstream>
#include <map>
#include <thread>

#include "tests/tools/cli_json.h"
#include "tests/tools/kitchen_copy.h"
#include "tests/tools/two_models.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

std::string state(double t, double robot, double box, bool held) {
  return Json{{"t", t}, {"state", {{"robot.x", robot}, {"box.x", box}, {"box.held", held}}}}
             .dump() +
         "\n";
}

std::string event(double t, const std::string& name, const std::string& outcome = "ok") {
  return Json{{"t", t}, {"event", name}, {"outcome", outcome}}.dump() + "\n";
}

/// Log of an execution of scenario.yaml's plan in which all goes well.
std::string fetching() {
  return state(0, 0.5, 1.5, false) + event(1, "Go(r2)") + state(1.1, 1.5, 1.5, false) +
         event(2, "PickUp()") + state(2.1, 1.5, 1.5, true) + event(3, "Go(r1)") +
         state(3.1, 0.5, 0.5, true) + event(4, "Place(r1)") + state(4.1, 0.5, 0.5, false);
}

TEST_CASE("a log of what the plan does is consistent, as a file, a pipe and CSV") {
  const CliFixture cli;
  cli.write("log.jsonl", fetching());
  const auto result = json_of(cli, {"monitor", "scenario.yaml", "log.jsonl"});
  CHECK(result.at("verdict") == "consistent");
  CHECK(result.at("observations") == 5);
  CHECK(result.at("compared") == 5);
  CHECK(result.at("events") == 4);
  CHECK(result.at("states") == Json{{"most", 1}, {"last", 1}});
  CHECK(result.at("unreported").empty());
  const auto text = cli.parallax({"monitor", "scenario.yaml", "log.jsonl"});
  CHECK(text.out ==
        "consistent: 5 observations (5 compared), 4 steps; at most 1 state possible at "
        "once, 1 at last\n");

  REQUIRE(::mkfifo((cli.folder() / "fifo").c_str(), 0600) == 0);
  std::thread writer([&] { std::ofstream(cli.folder() / "fifo") << fetching(); });
  CHECK(json_of(cli, {"monitor", "scenario.yaml", "fifo"}).at("observations") == 5);
  writer.join();

  cli.write("log.csv",
            "t,event,outcome,robot.x,box.x,box.held\n"
            "0,,,0.5,1.5,false\n1,Go(r2),ok,1.5,1.5,0\n2,PickUp(),ok,1.5,1.5,1\n"
            "3,Go(r1),,0.5,0.5,true\n4,Place(r1),ok,0.5,0.5,false\n");
  CHECK(json_of(cli, {"monitor", "scenario.yaml", "log.csv"}).at("observations") == 5);
}

TEST_CASE("the first observation that no state admits is located, with its values") {
  const CliFixture cli;
  cli.write("log.jsonl", state(0, 0.5, 1.5, false) + event(1, "Go(r2)") +
                             state(1.1, 0.9, 1.5, false) + "what comes after it is not read\n");
  const auto result = json_of(cli, {"monitor", "scenario.yaml", "log.jsonl"}, 1);
  CHECK(result.at("verdict") == "inconsistent");
  const auto& first = result.at("first");
  CHECK(first.at("line") == 3);
  CHECK(first.at("t") == 1.1);
  CHECK(first.at("timepoint") == 1);
  const Json fluents = {
      {{"fluent", "RobotIn(r1)"}, {"observed", true}, {"variables", {{"robot.x", 0.9}}}},
      {{"fluent", "RobotIn(r2)"}, {"observed", false}, {"variables", {{"robot.x", 0.9}}}}};
  CHECK(first.at("fluents") == fluents);
  const auto text = cli.parallax({"monitor", "scenario.yaml", "log.jsonl"});
  CHECK(text.code == 1);
  CHECK(
      text.out.find("log.jsonl:3: t = 1.1 s: no state that is still possible agrees with what was "
                    "seen\n  RobotIn(r1)   (robot.x = 0.9)\n  not RobotIn(r2)") == 0);
  // Where no state of any model is: a body that is nowhere.
  cli.write("log.jsonl", state(0, 0.5, 2.5, false));
  CHECK(json_of(cli, {"monitor", "scenario.yaml", "log.jsonl"}, 1)
            .at("first")
            .at("fluents")
            .at(0)
            .at("fluent") == "BoxIn(outside)");
}

TEST_CASE("events follow the plan, unless only the model is asked") {
  const CliFixture cli;
  cli.write("log.jsonl", state(0, 0.5, 1.5, false) + event(1, "Go(r2)") + event(2, "Go(r1)"));
  const auto result = json_of(cli, {"monitor", "scenario.yaml", "log.jsonl"}, 1);
  const auto& first = result.at("first");
  CHECK(first.at("line") == 3);
  CHECK(first.at("event") == "Go(r1)");
  CHECK(first.at("only_outcome") == false);
  REQUIRE(first.at("expected").size() == 1);
  CHECK(first.at("expected").at(0).get<std::string>().find("PickUp() (") == 0);
  CHECK(json_of(cli, {"monitor", "scenario.yaml", "log.jsonl", "--no-plan"}).at("verdict") ==
        "consistent");
  // Going always arrives, so it cannot fail.
  cli.write("log.jsonl", event(1, "Go(r2)", "failed"));
  CHECK(json_of(cli, {"monitor", "scenario.yaml", "log.jsonl"}, 1).at("first").at("only_outcome") ==
        true);
  // The plan is over, and the model goes on however long the log is.
  std::string longer = fetching();
  for (int i = 0; i < 200; ++i) longer += event(5 + i, i % 2 == 0 ? "Go(r2)" : "Go(r1)");
  cli.write("log.jsonl", longer);
  CHECK(json_of(cli, {"monitor", "scenario.yaml", "log.jsonl"}, 1)
            .at("first")
            .at("plan_may_be_over") == true);
  CHECK(json_of(cli, {"monitor", "scenario.yaml", "log.jsonl", "--no-plan"}).at("events") == 204);
}

TEST_CASE("what is not reported is not known, and what is under way is not compared") {
  const CliFixture cli;
  cli.write("log.jsonl", R"j({"t": 0, "state": {"robot.x": 0.5, "box.X": 1.5}}
{"t": 0.5, "started": "Go(r2)"}
{"t": 0.6, "state": {"robot.x": 7.0}}
{"t": 1, "event": "Go(r2)"}
{"t": 1.1, "state": {"robot.x": 1.2}}
)j");
  const auto result = json_of(cli, {"monitor", "scenario.yaml", "log.jsonl"});
  CHECK(result.at("observations") == 3);
  CHECK(result.at("compared") == 2);
  CHECK(result.at("under_way") == 1);
  CHECK(result.at("unreported") == Json::array({"box.x", "box.held"}));
  const auto text = cli.parallax({"monitor", "scenario.yaml", "log.jsonl"});
  CHECK(
      text.out.find("never reported: box.x, box.held\nthe log has `box.X`; is `box.x` meant?\n") !=
      std::string::npos);
  // With events, too: no name of a variable is right, so that nothing was compared.
  cli.write("log.jsonl",
            "{\"t\": 0, \"state\": {\"robot.X\": 0.5}}\n{\"t\": 1, \"event\": \"Go(r2)\"}\n"
            "{\"t\": 1.1, \"state\": {\"robot.X\": 1.2}}\n");
  const auto misspelt = json_of(cli, {"monitor", "scenario.yaml", "log.jsonl"}, 4);
  CHECK(misspelt.at("verdict") == "undecided");
  CHECK(misspelt.at("compared") == 0);
  CHECK(cli.parallax({"monitor", "scenario.yaml", "log.jsonl"})
            .out.find("so that nothing was compared") != std::string::npos);
  // A log that says nothing of the model decides nothing.
  cli.write("log.jsonl", "{\"t\": 0, \"state\": {\"arm.q\": 1}}\n");
  CHECK(json_of(cli, {"monitor", "scenario.yaml", "log.jsonl"}, 4).at("verdict") == "undecided");
  cli.write("log.jsonl", "");
  CHECK(cli.parallax({"monitor", "scenario.yaml", "log.jsonl"}).code == 4);
}

TEST_CASE("an action that never ends is told, and what it leaves uncompared decides nothing") {
  const CliFixture cli;
  const std::string begun = state(0, 0.5, 1.5, false) + R"j({"t": 0.5, "started": "Go(r2)"}
)j";
  cli.write("log.jsonl", begun + state(0.6, 7.0, 1.5, false));
  const auto result = json_of(cli, {"monitor", "scenario.yaml", "log.jsonl"}, 4);
  CHECK(result.at("verdict") == "undecided");
  CHECK(result.at("first").at("line") == 2);
  CHECK(result.at("because") ==
        "`Go(r2)` is begun and no `event` ends it: 1 later observation was not compared");
  CHECK(result.at("unended") == Json::array({Json{{"event", "Go(r2)"}, {"line", 2}, {"t", 0.5}}}));
  const auto text = cli.parallax({"monitor", "scenario.yaml", "log.jsonl"});
  CHECK(text.out.find("log.jsonl:2: t = 0.5 s: `Go(r2)` is begun") == 0);
  CHECK(text.out.find("not ended: Go(r2) (line 2, t = 0.5 s)\n") != std::string::npos);
  // Nothing was seen since.
  cli.write("log.jsonl", begun);
  CHECK(json_of(cli, {"monitor", "scenario.yaml", "log.jsonl"}).at("unended").size() == 1);
  cli.write("log.jsonl", begun + event(1, "Go(r2)"));
  CHECK(json_of(cli, {"monitor", "scenario.yaml", "log.jsonl"}).at("unended").empty());
}

TEST_CASE("a byte order mark is no part of a log") {
  const CliFixture cli;
  const std::string mark = "\xEF\xBB\xBF";
  cli.write("log", mark + fetching());
  CHECK(json_of(cli, {"monitor", "scenario.yaml", "log"}).at("events") == 4);
  cli.write("log", mark + "t,robot.x\r\n0,0.5\r\n");
  CHECK(json_of(cli, {"monitor", "scenario.yaml", "log"}).at("compared") == 1);
  cli.write("log", mark + "t,t\n");
  CHECK(cli.parallax({"monitor", "scenario.yaml", "log"}).err.find("log:1:6: error[E7401]") == 0);
  // Elsewhere a byte order mark is unexpected text.
  cli.write("log", "t,robot.x\n" + mark + "0,0.5\n");
  CHECK(cli.parallax({"monitor", "scenario.yaml", "log"}).code == 3);
}

TEST_CASE("events that the log does not name may have happened where the scenario says so") {
  const CliFixture cli;
  cli.write("slip.e",
            cli.read("domain.e") +
                "event Slip()\n"
                "[time] Terminates(Slip(),Holding(),time).\n"
                "[region,time] HoldsAt(RobotIn(region),time) & HoldsAt(Holding(),time) -> "
                "Initiates(Slip(),BoxIn(region),time).\n"
                "[time] Happens(Slip(),time) -> HoldsAt(Holding(),time).\n");
  const std::string problem = "model: [slip.e, start.e]\nhorizon: 6\n";
  cli.write("own.yaml", "include: common.yaml\n" + problem + "events: {unobserved: [Slip]}\n");
  const std::string lost = state(0, 0.5, 1.5, false) + event(1, "Go(r2)") + event(2, "PickUp()") +
                           state(2.1, 1.5, 1.5, true) + event(3, "Go(r1)") +
                           state(3.1, 0.5, 1.5, false);
  // On the way the box slipped in r2, and the robot went on without it.
  cli.write("log.jsonl", lost);
  const auto slipped = json_of(cli, {"monitor", "own.yaml", "log.jsonl"});
  // Held, or lying where it was picked up or where the robot has gone.
  CHECK(slipped.at("states").at("most") == 3);
  CHECK(slipped.at("states").at("last") == 1);
  // It cannot come back into the hand by itself.
  cli.write("back.jsonl", lost + state(3.2, 0.5, 0.5, true));
  CHECK(json_of(cli, {"monitor", "own.yaml", "back.jsonl"}, 1).at("first").at("line") == 7);
  // Where nothing may happen unseen it does not.
  cli.write("seen.yaml",
            "include: own.yaml\nevents: {unobserved: []}\n"
            "actions: {Slip(): {controller: going}}\n");
  CHECK(json_of(cli, {"monitor", "seen.yaml", "log.jsonl"}, 1).at("first").at("line") == 6);
  // An action for an unobserved event is still one for an event of the model.
  cli.write("both.yaml", "include: own.yaml\nactions: {Slip(): {controller: going}}\n");
  CHECK(cli.parallax({"monitor", "both.yaml", "log.jsonl"}).err.empty());
  CHECK(json_of(cli, {"monitor", "seen.yaml", "log.jsonl", "--unobserved", "Slip"}).at("verdict") ==
        "consistent");
  const auto unknown = cli.parallax({"monitor", "own.yaml", "log.jsonl", "--unobserved", "Slop"});
  CHECK(unknown.code == 3);
  CHECK(unknown.err.find("the model has no event `Slop`") != std::string::npos);
  CHECK(unknown.err.find("there is an event `Slip`") != std::string::npos);
}

TEST_CASE("what axioms demand beside a perform happens, though nobody tells of it") {
  const TwoModels cli;
  cli.write("two/slams.e",
            "load opens.e\nevent Slam()\n[time] Happens(Park(),time) -> Happens(Slam(),time).\n"
            "[drawer,time] Terminates(Slam(),Open(drawer),time).\n");
  cli.write("two/slams.yaml",
            "include: common.yaml\nmodel: [slams.e, start.e]\nsimulator: {model: slams.e}\n");
  json_of(cli, {"run", "two/slams.yaml", "--execution", "closed-loop", "--out", "out"});
  for (const auto& run : json_of(cli, {"monitor", "two/slams.yaml", "out"}).at("runs")) {
    CHECK(run.at("verdict") == "consistent");
  }
  // Not where nothing demands it, so the drawer stays open until then.
  const std::string opened = event(1, "OpenDrawer(top)");
  const std::string shut = R"j({"t": 2, "state": {"Open(top)": false}})j";
  cli.write("log.jsonl", opened + shut + "\n");
  CHECK(json_of(cli, {"monitor", "two/slams.yaml", "log.jsonl"}, 1).at("first").at("line") == 2);
  cli.write("log.jsonl", opened + event(2, "Park()") + shut + "\n");
  json_of(cli, {"monitor", "two/slams.yaml", "log.jsonl", "--no-plan"});
}

TEST_CASE("unobserved events happen while the plan waits, and nothing is known behind a cut") {
  const TwoModels cli;
  cli.write("two/slams.e",
            "load opens.e\nevent Slam()\n[drawer,time] Terminates(Slam(),Open(drawer),time).\n");
  cli.write("two/slams.yaml",
            "include: common.yaml\nmodel: [slams.e, start.e]\nsimulator: {model: slams.e}\n"
            "events: {unobserved: [Slam]}\n");
  const std::string shuts = event(1, "OpenDrawer(top)") +
                            R"j({"t": 2, "state": {"Open(top)": true}}
{"t": 3, "state": {"Open(top)": false}}
)j";
  cli.write("log.jsonl", shuts + event(4, "CloseDrawer(top)") + event(5, "Park()"));
  CHECK(json_of(cli, {"monitor", "two/slams.yaml", "log.jsonl"}).at("events") == 3);
  // The plan has not gone on meanwhile.
  cli.write("log.jsonl", shuts + event(4, "Park()"));
  CHECK(json_of(cli, {"monitor", "two/slams.yaml", "log.jsonl"}, 1).at("first").at("line") == 4);

  cli.write("two/many.lisp", R"((def-cram-function many ()
  (let ((n 0))
    (loop (setf n (+ n 1))
          (perform (an action (type opening) (object (an object (name top)))))
          (perform (an action (type closing) (object (an object (name top))))))))
(many)
)");
  cli.write("two/many.yaml",
            "include: slams.yaml\nplan: many.lisp\nconstraints: \"HoldsAt(Open(top),time)\"\n");
  std::string log;
  for (int i = 0; i < 32; ++i) {
    log += event(i, i % 2 == 0 ? "OpenDrawer(top)" : "CloseDrawer(top)");
  }
  cli.write("log.jsonl", log);
  json_of(cli, {"monitor", "two/many.yaml", "log.jsonl"});
  cli.write("log.jsonl", log + event(40, "OpenDrawer(top)"));
  const auto cut = json_of(cli, {"monitor", "two/many.yaml", "log.jsonl"}, 4);
  CHECK(cut.at("verdict") == "undecided");
  CHECK(cut.at("first").at("line") == 33);
  CHECK(cut.at("because").get<std::string>().find("`loop` at two/many.lisp:3") !=
        std::string::npos);
  // An event that the axioms rule out is inconsistent there as well.
  cli.write("two/closed.e",
            "[drawer,time] Happens(CloseDrawer(drawer),time) -> HoldsAt(Open(drawer),time).\n");
  cli.write("two/closed.yaml", "include: many.yaml\nmodel: [slams.e, start.e, closed.e]\n");
  cli.write("log.jsonl", log + event(40, "CloseDrawer(top)"));
  CHECK(json_of(cli, {"monitor", "two/closed.yaml", "log.jsonl"}, 1).at("first").at("line") == 33);
}

TEST_CASE("bad lines are located, and what came before them is not lost") {
  const CliFixture cli;
  const std::string good = state(0, 0.5, 1.5, false) + event(1, "Go(r2)");
  const std::pair<std::string, std::string> cases[] = {
      {event(0.5, "PickUp()"),
       "log:3:1: error[E7401]: the log cannot be read on: time runs backwards"},
      {event(2, "PickUP()"), "there is an event `PickUp()`"},
      {"{\"t\": 2, \"event\": \"Pick", "the log ends in the middle of this line"},
      {"{\"t\": 2, \"event\": \"Pick\n", "log:3:"},
      {"{\"t\": 2, \"state\": {\"robot.x\": NaN}}\n", "it is no JSON object as far as it goes"},
      {"{\"t\": 2, \"state\": {\"robot.x\": \"\xff\"}}\n", "this byte is not of UTF-8 text"},
      {"{\"t\": 2, \"state\": {\"robot.x\": true}}\n", "`robot.x` is a number"},
      {std::string(2U << 20U, ' ') + "\n", "the line is longer than 1048576 bytes"}};
  for (const auto& [bad, wanted] : cases) {
    CAPTURE(wanted);
    cli.write("log", good + bad);
    const auto result = cli.parallax({"monitor", "scenario.yaml", "log"});
    CHECK(result.code == 3);
    CHECK(result.err.find(wanted) != std::string::npos);
    CHECK(result.out.find("consistent as far as the log can be read: 1 observation ") == 0);
    const auto json = json_of(cli, {"monitor", "scenario.yaml", "log"}, 3);
    CHECK(json.at("status") == "error");
    CHECK(json.at("diagnostics").size() == 1);
    CHECK(json.at("events") == 1);
    CHECK(json.at("verdict") == "undecided");
    CHECK(json.at("because").get<std::string>().find(
              "line 3 cannot be read; what comes before it is consistent") == 0);
  }
  cli.write("log", "t,robot.x\n0,0.5\n1\n");
  const auto few = cli.parallax({"monitor", "scenario.yaml", "log"});
  CHECK(few.code == 3);
  CHECK(few.err.find("log:3:1: error[E7401]: the log cannot be read on: it has 1 cells, and the "
                     "header 2") != std::string::npos);
  CHECK(cli.parallax({"monitor", "scenario.yaml", "nothing"}).code == 2);
  CHECK(cli.parallax({"monitor", "domain.e", "log"}).code == 3);
  // An axiom that spans three timepoints cannot be followed.
  cli.write("far.e", cli.read("domain.e") +
                         "[time] HoldsAt(Holding(),time) -> HoldsAt(Holding(),time+2).\n");
  cli.write("far.yaml", "include: common.yaml\nmodel: far.e\nhorizon: 6\n");
  const auto far = cli.parallax({"monitor", "far.yaml", "log"});
  CHECK(far.code == 3);
  CHECK(far.err.find("error[E7402]") != std::string::npos);
}

TEST_CASE("with compare: final what is seen before the last line does not count") {
  const CliFixture cli;
  cli.write("final.yaml", "include: scenario.yaml\ncompare: final\n");
  const std::string odd =
      state(0, 0.5, 1.5, false) + event(1, "Go(r2)") + state(1.1, 0.5, 1.5, false);
  cli.write("log.jsonl", odd + state(1.2, 1.5, 1.5, false));
  CHECK(json_of(cli, {"monitor", "scenario.yaml", "log.jsonl"}, 1).at("first").at("line") == 3);
  CHECK(json_of(cli, {"monitor", "final.yaml", "log.jsonl"}).at("compared") == 2);
  cli.write("log.jsonl", odd);
  CHECK(json_of(cli, {"monitor", "final.yaml", "log.jsonl"}, 1).at("first").at("line") == 3);
}

TEST_CASE("a plan of the kitchen is followed: what a search came to tells where the spoon is not") {
  const KitchenCopy cli;
  const auto check = [&](const std::string& log, int code) {
    cli.write("log.jsonl", log);
    return json_of(cli, {"monitor", "kitchen/plan2.yaml", "log.jsonl"}, code);
  };
  const std::string opened = event(1, "OpenDrawer(left,dTop)") + event(2, "LookAt(dTop)");
  // Six ways to lay milk, cereal and bowl out, and three drawers.
  CHECK(check(opened, 0).at("states") == Json{{"most", 18}, {"last", 18}});
  CHECK(check(opened + event(3, "Detect(spoon)"), 0).at("states").at("last") == 6);
  const std::string missed = opened + event(3, "Detect(spoon)", "failed");
  CHECK(check(missed, 0).at("states").at("last") == 12);
  CHECK(check(missed + event(4, "CloseDrawer(left,dTop)"), 0).at("states").at("last") == 12);
  const auto first = check(missed + event(4, "PickUp(left,spoon1)"), 1).at("first");
  CHECK(first.at("line") == 4);
  REQUIRE(first.at("expected").size() == 1);
  CHECK(first.at("expected").at(0).get<std::string>().find("CloseDrawer(left,dTop) (") == 0);
}

TEST_CASE("too many possible states are said, not guessed") {
  const CliFixture cli;
  cli.write("own.yaml", "include: common.yaml\nmodel: domain.e\nhorizon: 6\n");
  cli.write("log.jsonl", event(1, "Go(r2)"));
  const auto result = json_of(cli, {"monitor", "own.yaml", "log.jsonl", "--max-states", "2"}, 4);
  CHECK(result.at("verdict") == "undecided");
  CHECK(result.at("because") == "more than 2 initial states are possible");
  CHECK(json_of(cli, {"monitor", "own.yaml", "log.jsonl"}).at("states").at("most") == 6);
}

TEST_CASE("every recorded simulation is checked again: discrepancies at their steps, no others") {
  const CliFixture cli;
  for (const auto* scenario : {"edge", "scenario", "wrong_model"}) {
    CAPTURE(scenario);
    const std::string yaml = std::string(scenario) + ".yaml", out = std::string("out/") + scenario;
    const auto ran =
        cli.parallax({"run", yaml, "--out", out, "--keep-going", "--epsilon", "0.3", "--json"});
    const auto report = Json::parse(ran.out);
    std::map<std::string, Json> divergences;
    for (const auto& found : report.at("discrepancies")) {
      divergences[std::to_string(found.at("trace").get<int>()) + "." +
                  std::to_string(found.at("sample").get<int>())] = found.at("first_divergence");
    }
    CHECK(divergences.empty() == (std::string(scenario) == "scenario"));
    const auto checked = json_of(cli, {"monitor", yaml, out}, divergences.empty() ? 0 : 1);
    CHECK(checked.at("runs").size() == report.at("simulations"));
    for (const auto& run : checked.at("runs")) {
      const auto found = divergences.find(run.at("sample"));
      CAPTURE(run.dump());
      if (found == divergences.end()) {
        CHECK(run.at("verdict") == "consistent");
      } else {
        CHECK(run.at("verdict") == "inconsistent");
        CHECK(run.at("first").at("timepoint") == found->second);
      }
    }
  }
  // A value that no simulator of the scenario reports is no observation.
  auto journal = cli.read("out/scenario/journal.ndjson");
  const std::string held = R"j("box.held":false)j";
  const auto at = journal.find(held, journal.find(R"j("observations":[)j"));
  REQUIRE(at != std::string::npos);
  cli.write("out/scenario/journal.ndjson",
            journal.replace(at, held.size(), R"j("box.held":"no")j"));
  const auto odd = cli.parallax({"monitor", "scenario.yaml", "out/scenario"});
  CHECK(odd.code == 3);
  CHECK(odd.err.find("out/scenario/journal.ndjson:3:") == 0);
  CHECK(odd.err.find("error[E7103]") != std::string::npos);
  CHECK(odd.err.find("`box.held` at timepoint 0") != std::string::npos);
  // Only with the scenario that was run.
  CHECK(cli.parallax({"monitor", "scenario.yaml", "out/edge"}).code == 3);
}

}  // namespace
}  // namespace parallax::test
