// Claims about a plan cover no more than was explored of it: branches in one order,
// forms that are approximated, loops and calls up to their bounds.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A drawer that opens and an arm that is parked, with plans over them.
class DrawerPlans : public CliFixture {
 public:
  DrawerPlans() {
    write("drawer.e",
          "sort drawer\ndrawer top\nfluent Open(drawer)\nfluent Parked()\n"
          "event OpenDrawer(drawer)\nevent Park()\n"
          "[drawer,time] Initiates(OpenDrawer(drawer),Open(drawer),time).\n"
          "[time] Initiates(Park(),Parked(),time).\n"
          "[drawer] !HoldsAt(Open(drawer),0).\nHoldsAt(Parked(),0).\n");
    write("robot.bind",
          "action opening (:object ?d) -> OpenDrawer(?d) ok: Open(?d) @t+1\n"
          "action parking-arms () -> Park() ok: Parked() @t+1\n");
    // Parks for ever, as it finds the arm parked.
    write("again.lisp",
          "(def-cram-function p ()\n"
          "  (if (holds '(parked)) (progn (perform (an action (type parking-arms))) (p))\n"
          "      (perform (an action (type opening) (object (an object (name top)))))))\n(p)\n");
    write("par.lisp",
          "(def-cram-function p ()\n"
          "  (par (perform (an action (type opening) (object (an object (name top)))))\n"
          "       (perform (an action (type parking-arms)))))\n(p)\n");
    write("goal.lisp",
          "(def-cram-function p ()\n"
          "  (perform (an action (type parking-arms) (goal (arms-parked))))\n"
          "  (perform (an action (type opening) (object (an object (name top))))))\n(p)\n");
    // Parking at 0 instead of opening: what the other order of par.lisp does.
    write("closed0.e", "!Happens(OpenDrawer(top),0).\n");
    write("always.e", "[time] Happens(Park(),time).\n");
  }
  /// A scenario whose world is the model.
  std::string scenario(const std::string& plan, const std::string& more) const {
    write("own.yaml", "name: own\nmodel: [drawer.e]\nplan: " + plan +
                          "\nbind: robot.bind\nsimulator: {model: drawer.e}\n" + more);
    return "own.yaml";
  }
  /// Arguments of a command over the plan.
  static std::vector<std::string> with(std::vector<std::string> arguments,
                                       const std::string& plan) {
    for (const auto& word : {std::string("drawer.e"), std::string("--plan"), plan,
                             std::string("--bind"), std::string("robot.bind")}) {
      arguments.push_back(word);
    }
    return arguments;
  }
};

TEST_CASE("behind a cut there is no trace, and nothing is proved") {
  const DrawerPlans cli;
  const auto ask = [&](const std::string& until, const std::string& depth) {
    return cli.parallax(DrawerPlans::with({"traces", "--until", until, "--horizon", "11", "--limit",
                                           "0", "--certify=c.drat", "--max-call-depth", depth},
                                          "again.lisp"));
  };
  // Eight calls park at 0 to 7; nothing is known of 8.
  const auto behind = ask("time=9", "8");
  CAPTURE(behind.out);
  CHECK(says(behind.out,
             "0 traces, complete up to bound (within the bounds of loops and calls, "
             "no proof)"));
  CHECK(says(behind.err, "bound reached: `p` at again.lisp:2"));
  const auto before = ask("time=8", "8");
  CHECK(says(before.out, "1 trace, "));
  const auto deeper = ask("time=9", "20");
  CHECK(says(deeper.out, "1 trace, all traces explored (proof checked)"));
}

TEST_CASE("what stands behind a cut violates no property") {
  const DrawerPlans cli;
  const auto ask = [&](const std::string& property, const std::string& depth) {
    return cli.parallax(DrawerPlans::with(
        {"verify", "--property", property, "--horizon", "11", "--max-call-depth", depth},
        "again.lisp"));
  };
  for (const std::string property :
       {"time=9 -> Happens(Park(),time-1)", "always (next (0=0) -> Happens(Park(),time))"}) {
    CAPTURE(property);
    const auto cut = ask(property, "8");
    CAPTURE(cut.out);
    CHECK(cut.code == 0);
    CHECK(cut.out.starts_with(
        "holds up to horizon 11 (within the bounds of loops and calls, no proof)"));
    CHECK(ask(property, "20").code == 0);
  }
  // A state before the cut violates a property all the same.
  CHECK(ask("!Happens(Park(),time-1) | time<5", "8").code == 1);
}

TEST_CASE("an optimum beside a cut is not proved") {
  const DrawerPlans cli;
  const auto found =
      cli.parallax(DrawerPlans::with({"traces", "--minimize", "count Happens(Park(),time)",
                                      "--until", "time=8", "--horizon", "11", "--certify=m.drat"},
                                     "again.lisp"));
  CAPTURE(found.out);
  CHECK(says(found.out, "optimum 8 (within the bounds of loops and calls, no proof)"));
}

TEST_CASE("a contradiction is not proved of a plan that was not explored in full") {
  const DrawerPlans cli;
  auto arguments = DrawerPlans::with(
      {"verify", "--property", "HoldsAt(Parked(),time)", "--horizon", "4", "closed0.e"},
      "par.lisp");
  const auto order = cli.parallax(arguments);
  CHECK(order.code == 3);
  CHECK(says(order.err, "error[E7001]"));
  CHECK(says(order.err, "note: not explored: the other orders of `par` at par.lisp:2"));
  CHECK(says(order.err, "note: nothing is proved"));
  CHECK_FALSE(says(order.err, "proof of the contradiction was checked"));
  arguments.emplace_back("--par=interleave");
  CHECK(cli.parallax(arguments).code == 0);
  const auto sets =
      cli.parallax({"explain", cli.scenario("par.lisp", "horizon: 4\nconstraints: \"time=2\"\n")});
  CHECK(sets.code == 0);
  cli.replace("own.yaml", "[drawer.e]", "[drawer.e, closed0.e]");
  const auto set = cli.parallax({"explain", "own.yaml"});
  CAPTURE(set.out);
  CHECK(says(set.out, "axioms (not of every order, no proof)"));
  CHECK(json_of(cli, {"explain", "own.yaml"}, 1)["sets"][0]["proof"] == "none");
}

TEST_CASE("consequences say what was not explored, and decide nothing behind a cut") {
  const DrawerPlans cli;
  const auto cut = json_of(
      cli,
      DrawerPlans::with({"consequences", "--horizon", "6", "--max-call-depth", "3"}, "again.lisp"),
      4);
  CHECK(cut["complete"] == false);
  CHECK(cut["cut"] == true);
  for (const auto& fact : cut["facts"]) {
    if (fact["name"] != "Park()") continue;
    CAPTURE(fact.dump());
    CHECK(fact["in"] == (fact["time"] < 3 ? "always" : "undecided"));
  }
  const auto order =
      json_of(cli, DrawerPlans::with({"consequences", "--horizon", "4"}, "par.lisp"));
  CHECK(order["complete"] == false);
  CHECK(order["every_order"] == false);
  const auto text = cli.parallax(DrawerPlans::with({"consequences", "--horizon", "4"}, "par.lisp"));
  CHECK(text.out.starts_with("in all traces (not of every order)\n"));
  const auto every = json_of(
      cli, DrawerPlans::with({"consequences", "--horizon", "4", "--par=interleave"}, "par.lisp"));
  CHECK(every["complete"] == true);
}

TEST_CASE("runs and rates claim nothing of orders that were not explored") {
  const DrawerPlans cli;
  const auto scenario = cli.scenario("par.lisp", "horizon: 4\nconstraints: \"time=2\"\n");
  const auto run = cli.parallax({"run", scenario, "--out", "run"});
  CAPTURE(run.out);
  CHECK(run.code == 0);
  CHECK(says(run.out, "(not of every"));
  CHECK(says(run.out, "bound     not explored: the other orders of `par` at"));
  CHECK_FALSE(says(run.out, "all traces explored"));
  const auto report = nlohmann::json::parse(cli.read("run/report.json"));
  CHECK(report["exploration"] == "complete up to bound");
  REQUIRE(report["bounds"].size() == 1);
  CHECK(says(cli.read("run/report.txt"), "not explored: the other orders of `par`"));
  const auto rates = json_of(cli, {"rates", scenario, "--runs", "5"});
  CHECK(rates["bounds"].size() == 1);
}

TEST_CASE("executions of a plan are claimed in the order in which they are made") {
  const DrawerPlans cli;
  const auto scenario = cli.scenario("par.lisp", "execution: closed-loop\nhorizon: 4\n");
  const auto run = cli.parallax({"run", scenario, "--out", "loop"});
  CAPTURE(run.out);
  CAPTURE(run.err);
  CHECK(run.code == 0);
  CHECK(says(run.out, "(not of every order)"));
  CHECK(says(run.out, "bound     not explored: the other orders of `par` at"));
}

TEST_CASE("a log of an execution that was not explored is undecided") {
  const DrawerPlans cli;
  const auto scenario = cli.scenario("par.lisp", "horizon: 4\nconstraints: \"time=2\"\n");
  cli.write("other.jsonl",
            "{\"t\":0,\"event\":\"Park()\"}\n{\"t\":1,\"event\":\"OpenDrawer(top)\"}\n");
  const auto other = json_of(cli, {"monitor", scenario, "other.jsonl"}, 4);
  CHECK(other["verdict"] == "undecided");
  // No order of the plan makes the arm leave its place.
  cli.write("wrong.jsonl",
            "{\"t\":0,\"event\":\"OpenDrawer(top)\"}\n"
            "{\"t\":1,\"state\":{\"Open(top)\":false,\"Parked()\":true}}\n");
  CHECK(json_of(cli, {"monitor", scenario, "wrong.jsonl"}, 1)["verdict"] == "inconsistent");
}

TEST_CASE("a trace that was not explored is undecided when it is replayed") {
  const DrawerPlans cli;
  const auto listed =
      cli.parallax(DrawerPlans::with({"traces", "--until", "time=2", "--horizon", "4", "--limit",
                                      "0", "--par=interleave", "--format", "jsonl"},
                                     "par.lisp"));
  cli.write("both.jsonl", listed.out);
  auto arguments = DrawerPlans::with(
      {"traces", "--until", "time=2", "--horizon", "4", "--replay", "both.jsonl", "--other-model"},
      "par.lisp");
  const auto replayed = cli.parallax(arguments);
  CAPTURE(replayed.err);
  CHECK(replayed.code == 4);
  CHECK(says(replayed.out, "2 traces replayed, complete: 1 agree, 0 fail, 1 undecided, 1 checked"));
  arguments.emplace_back("--par=interleave");
  CHECK(cli.parallax(arguments).code == 0);
}

TEST_CASE("options of plans go for scenarios, or are refused") {
  const DrawerPlans cli;
  const auto scenario = cli.scenario("par.lisp", "horizon: 4\nconstraints: \"time=2\"\n");
  CHECK(json_of(cli, {"traces", scenario, "--limit=0"})["traces"] == 1);
  const auto both = json_of(cli, {"traces", scenario, "--limit=0", "--par=interleave"});
  CHECK(both["traces"] == 2);
  CHECK(both["complete"] == true);
  CHECK(json_of(cli, {"traces", scenario, "--limit=0", "--horizon", "1"})["traces"] == 0);
  const std::vector<std::vector<std::string>> refused = {
      {"--plan", "goal.lisp", "--bind", "robot.bind"},
      {"--compat", "decreasoner"},
      {"--until", "time=1"},
      {"--max-horizon", "7"}};
  for (const auto& more : refused) {
    for (const std::string command : {"traces", "consequences", "check"}) {
      std::vector<std::string> arguments = {command, scenario};
      arguments.insert(arguments.end(), more.begin(), more.end());
      const auto result = cli.parallax(arguments);
      CAPTURE(command);
      CAPTURE(more.front());
      CHECK(result.code == 2);
      CHECK(says(result.err, scenario));
    }
  }
  REQUIRE(cli.parallax({"compile", "drawer.e", "--horizon", "2", "-o", "drawer.dec.cnf"}).code ==
          0);
  const auto compiled =
      cli.parallax({"traces", "drawer.dec.cnf", "--plan", "par.lisp", "--bind", "robot.bind"});
  CHECK(compiled.code == 2);
  CHECK(says(compiled.err, "--plan"));
}

TEST_CASE("a suite does not pass where a plan was not explored in full") {
  const DrawerPlans cli;
  cli.scenario("par.lisp", "horizon: 4\nconstraints: \"time=2\"\n");
  cli.write("suite.yaml",
            "cases:\n"
            "  - {id: holds, model: own.yaml, expect: {holds: \"HoldsAt(Parked(),time)\"}}\n"
            "  - {id: count, model: own.yaml, expect: {traces: 1}}\n");
  const auto suite = cli.parallax({"suite", "suite.yaml", "--out", "suite"});
  CAPTURE(suite.out);
  CHECK(suite.code != 0);
  CHECK(says(suite.out, "2 inconclusive"));
  CHECK(says(suite.out, "not of every order"));
}

TEST_CASE("gates decide nothing of a plan that was not explored in full") {
  const DrawerPlans cli;
  const auto text =
      "name: own\nmodel: [../drawer.e]\nplan: ../par.lisp\nbind: ../robot.bind\nhorizon: 4\n"
      "simulator: {model: ../drawer.e}\nconstraints: \"time=2\"\n";
  for (const std::string side : {"old", "new"}) {
    std::filesystem::create_directory(cli.folder() / side);
    cli.write(side + "/own.yaml", text);
  }
  cli.write(".parallax-root", "");
  cli.write("gate.yaml",
            "models: {lost_traces: forbidden, properties: [\"HoldsAt(Parked(),time)\"]}\n");
  const auto gate = cli.parallax({"diff", "old/own.yaml", "new/own.yaml", "--gate", "gate.yaml"});
  CAPTURE(gate.out);
  CAPTURE(gate.err);
  CHECK(gate.code == 1);
  CHECK(says(gate.out, "not of every order"));
}

TEST_CASE("a temporal property of which no instance says anything is refused") {
  const DrawerPlans cli;
  for (const std::string property :
       {"!HoldsAt(Parked(),time-50)", "always !HoldsAt(Parked(),time-50)",
        "always (HoldsAt(Parked(),time) | eventually HoldsAt(Parked(),time-50))"}) {
    CAPTURE(property);
    const auto result =
        cli.parallax({"verify", "drawer.e", "--horizon", "4", "--property", property});
    CHECK(result.code == 3);
    CHECK(says(result.err, "error[E3004]"));
  }
  const auto fine = cli.parallax(
      {"verify", "drawer.e", "--horizon", "4", "--property", "always HoldsAt(Parked(),time-3)"});
  CHECK(fine.code == 0);
}

}  // namespace
}  // namespace parallax::test
