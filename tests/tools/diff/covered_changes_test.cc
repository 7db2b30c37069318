// Gates and suites: that a verdict covers what its words say. In each case something that decides
// on the answer changed, and the answer must not be that nothing is worse.

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// One of the scenarios' folders twice, as `a` and `b`.
class TwoSides : public CliFixture {
 public:
  explicit TwoSides(const std::string& scenarios = "") {
    for (const std::string side : {"a", "b"}) {
      if (scenarios.empty()) {
        fs::create_directories(folder() / side);
      } else {
        fs::copy(fs::path(PARALLAX_SOURCE_DIR) / "scenarios" / scenarios, folder() / side,
                 fs::copy_options::recursive);
      }
    }
  }
  void put(const std::string& name, const std::string& text) const {
    fs::create_directories((folder() / name).parent_path());
    write(name, text);
  }
  void both(const std::string& name, const std::string& text) const {
    put("a/" + name, text);
    put("b/" + name, text);
  }
  /// The gate's answer must have this exit code and these words.
  void gate(const std::string& rules, std::vector<std::string> sides, int code,
            const std::string& words, ProcessOptions options = {}) const {
    write("rules.yaml", rules);
    sides.insert(sides.begin(), {"diff", "--gate", (folder() / "rules.yaml").string()});
    const auto answer = parallax(std::move(sides), std::move(options));
    CHECK_MESSAGE(answer.code == code, answer.out, answer.err);
    CHECK_MESSAGE(says(answer.out, words), "no `", words, "` in:\n", answer.out, answer.err);
  }
  void keep(const std::vector<std::string>& command, const std::string& file) const {
    const auto answer = parallax(command);
    CHECK_MESSAGE((answer.code == 0 || answer.code == 1), answer.err);
    write(file, answer.out);
  }
};

constexpr const char* kRerun =
    "models: {physics: {rerun: {runs: 12, margin: 0.9, seconds: 200}}}\n";

TEST_CASE("a pose of the plan is what is simulated") {
  const TwoSides sides("two_regions");
  const std::vector<std::string> files = {"a/edge.yaml", "b/edge.yaml"};
  sides.gate("models: {physics: forbidden}\n", files, 0, "kept           models.physics");
  sides.replace("b/edge.lisp", "(make-3d-vector 0.985 0 0)", "(make-3d-vector 0.7 0 0)");
  const std::string change = "actions.Place(r1).from the plan.target.x 0.985 -> 0.7";
  sides.gate("models: {physics: forbidden}\n", files, 1,
             "broken         models.physics: " + change);
  sides.gate("models: {settings: forbidden}\n", files, 1, change);
  sides.gate("models: {actions: forbidden}\n", files, 1, change);
  sides.gate("models: {starts: forbidden, judgement: forbidden}\n", files, 0, "all 2 rules are");
  sides.gate(kRerun, files, 0, "12 runs of each trace, old and new, with seed 1");
  // Compiled models show it, too.
  for (const std::string side : {"a", "b"}) {
    CHECK(sides.parallax({"compile", side + "/edge.yaml", "-o", side + ".dec.cnf"}).code == 0);
  }
  const auto compiled = sides.parallax({"diff", "a.dec.cnf", "b.dec.cnf"});
  CHECK(compiled.code == 1);
  CHECK_MESSAGE(says(compiled.out, "target.x"), compiled.out);
}

TEST_CASE("a rule about plans holds in folders") {
  const TwoSides sides("two_regions");
  const std::string rules = "plans: {forms: forbidden, order: forbidden}\n";
  sides.gate(rules, {"a", "b"}, 0, "plans and binding tables changed");
  sides.replace("b/edge.lisp", "(make-3d-vector 0.985 0 0)", "(make-3d-vector 0.7 0 0)");
  sides.gate(rules, {"a", "b"}, 1, "broken         edge.lisp: plans.forms");
}

TEST_CASE("runs are made again where plan, binding table or model changed") {
  const TwoSides sides("two_models");
  const std::vector<std::string> files = {"a/agree.yaml", "b/agree.yaml"};
  sides.gate(kRerun, files, 0, "none changed, neither physics nor model, plan or binding table");
  sides.replace("b/robot.bind", "else manipulation-goal-not-reached\naction reaching",
                "else manipulation-pose-unreachable\naction reaching");
  sides.gate(kRerun, files, 0, "of model, plan and binding table changed; 0 of 12 before");
  // A trace that the other side has not cannot be compared.
  sides.replace("b/open_and_close.lisp", "(type parking-arms)", "(type reaching)");
  sides.gate(kRerun, files, 1, "not decidable  models.physics");
}

TEST_CASE("the order of a binding table decides, and so is a change") {
  const TwoSides sides("two_models");
  sides.both("robot.bind",
             "action opening (:object ?d) -> OpenDrawer(?d) ok: Open(?d) @t+1 else "
             "manipulation-goal-not-reached\n"
             "action opening (:object top) -> Reach() ok: !Parked() @t+1 else "
             "manipulation-goal-not-reached\n");
  sides.put("b/robot.bind",
            "action opening (:object top) -> Reach() ok: !Parked() @t+1 else "
            "manipulation-goal-not-reached\n"
            "action opening (:object ?d) -> OpenDrawer(?d) ok: Open(?d) @t+1 else "
            "manipulation-goal-not-reached\n");
  const auto told = sides.parallax({"diff", "a/robot.bind", "b/robot.bind"});
  CHECK_MESSAGE(told.code == 1, told.out, told.err);
  sides.gate("plans: {order: forbidden}\n", {"a/robot.bind", "b/robot.bind"}, 1,
             "broken         plans.order");
  // An entry more is no other order.
  sides.put("b/robot.bind", sides.read("a/robot.bind") +
                                "action closing (:object ?d) -> CloseDrawer(?d) ok: !Open(?d) @t+1 "
                                "else manipulation-goal-not-reached\n");
  sides.gate("plans: {order: forbidden}\n", {"a/robot.bind", "b/robot.bind"}, 0, "none changed");
}

TEST_CASE("the first initial state follows from the order of the declarations") {
  const TwoSides sides;
  const std::string model =
      "fluent At(spot)\nfluent Done()\nevent Finish()\n"
      "[time] {spot} HoldsAt(At(spot),time).\n"
      "[spot1,spot2,time] HoldsAt(At(spot1),time) & HoldsAt(At(spot2),time) -> spot1=spot2.\n"
      "!HoldsAt(Done(),0).\n";
  const std::string effect = "[time] Initiates(Finish(),Done(),time).\n";
  sides.both("m.e", "sort spot\nspot s1, s2\n" + model + effect);
  sides.both("w.e", "sort spot\nspot s1, s2\n" + model +
                        "[time] HoldsAt(At(s1),time) -> Initiates(Finish(),Done(),time).\n");
  sides.both("p.lisp", "(def-cram-function f () (perform (an action (type finishing))))\n(f)\n");
  sides.both(
      "r.bind",
      "action finishing () -> Finish() ok: Done() @t+1 else manipulation-goal-not-reached\n");
  const std::string scenario =
      "model: m.e\nplan: p.lisp\nbind: r.bind\nhorizon: 1\nconstraints: HoldsAt(Done(),time)\n"
      "simulator: {model: w.e}\n";
  sides.both("first.yaml", scenario + "initial: first\n");
  sides.both("all.yaml", scenario);
  sides.put("b/m.e", "sort spot\nspot s2, s1\n" + model + effect);
  const std::string rules = "models: {declarations: forbidden, axioms: forbidden}\n";
  sides.gate(rules, {"a/first.yaml", "b/first.yaml"}, 1, "broken         models.declarations");
  sides.gate(rules, {"a/all.yaml", "b/all.yaml"}, 0, "all 2 rules are kept");
  // Rates of other initial states are no rates of the same.
  for (const std::string side : {"a", "b"}) {
    sides.keep({"rates", side + "/first.yaml", "--runs", "40", "--json"}, side + ".json");
  }
  sides.gate("rates: {worse: {margin: 0.5}}\n", {"a.json", "b.json"}, 1,
             "begin in other initial states");
}

TEST_CASE("rates that compare less or begin elsewhere are not compared") {
  const TwoSides sides("two_models");
  const std::string rules = "rates: {worse: {margin: 0.5}, gained_causes: forbidden}\n";
  const std::vector<std::string> files = {"a.json", "b.json"};
  const auto rates = [&](const std::string& scenario) {
    for (const std::string side : {"a", "b"}) {
      sides.keep({"rates", side + "/" + scenario, "--runs", "40", "--json"}, side + ".json");
    }
  };
  rates("sticks.yaml");
  sides.gate(rules, files, 0, "gate passed");
  const auto document = Json::parse(sides.read("a.json"));
  CHECK(document["compared"].size() == 2);
  CHECK(document["simulator"].get<std::string>().starts_with("model"));
  for (const auto* name : {"scenario_hash", "starts_hash", "judging_hash"}) {
    CHECK(document[name].get<std::string>().size() >= 16);
  }
  sides.put("b/sticks.yaml", sides.read("b/sticks.yaml") + "mapping: {Open(d): ignored}\n");
  rates("sticks.yaml");
  sides.gate(rules, files, 1, "another comparison: a.json compares Open(..) every-step");
  // A file of an earlier version does not say it.
  auto older = document;
  for (const auto* name : {"compared", "match", "starts_hash", "judging_hash"}) older.erase(name);
  sides.write("older.json", older.dump());
  sides.gate(rules, {"older.json", "a.json"}, 1, "older.json does not say which fluents");

  const TwoSides regions("two_regions");
  regions.replace("b/common.yaml", "r1: {x: [0, 1]}", "r1: {x: [0, 1], start: {x: [0.9, 0.95]}}");
  for (const std::string side : {"a", "b"}) {
    regions.keep({"rates", side + "/scenario.yaml", "--runs", "2", "--json"}, side + ".json");
  }
  regions.gate("rates: {worse: {margin: 0.9}}\n", files, 1, "runs of b.json begin elsewhere");
}

TEST_CASE("runs that compare less or begin elsewhere are no better") {
  const TwoSides sides("two_models");
  const std::string rules = "runs: {gained_discrepancies: forbidden, worse_verdict: forbidden}\n";
  const std::string clean = "criterion: {confidence: 0.9, epsilon: 0.4}\n";
  for (const std::string side : {"a", "b"}) {
    sides.put(side + "/agree.yaml", sides.read(side + "/agree.yaml") + clean);
  }
  const auto run = [&](const std::string& side) {
    CHECK(sides.parallax({"run", side + "/agree.yaml", "--out", "out/" + side}).code == 0);
  };
  run("a");
  run("b");
  sides.gate(rules, {"out/a", "out/b"}, 0, "all 2 rules are kept");
  sides.replace("b/agree.yaml", "simulator: {model: opens.e}", "simulator: {model: unparks.e}");
  sides.put("b/agree.yaml", sides.read("b/agree.yaml") + "mapping: {Parked(): ignored}\n");
  fs::remove_all(sides.folder() / "out/b");
  run("b");
  sides.gate(rules, {"out/a", "out/b"}, 1, "not decidable  runs.gained_discrepancies: another");
  sides.gate(rules, {"out/a", "out/b"}, 1, "not decidable  runs.worse_verdict: no-discrepancy as");
}

TEST_CASE("a rerun that compares less says nothing") {
  const TwoSides sides("two_models");
  sides.replace("b/agree.yaml", "simulator: {model: opens.e}", "simulator: {model: unparks.e}");
  const std::vector<std::string> files = {"a/agree.yaml", "b/agree.yaml"};
  sides.gate(kRerun, files, 1, "models.physics");
  sides.put("b/agree.yaml",
            sides.read("b/agree.yaml") + "mapping: {Parked(): {flag: Parked(), compare: final}}\n");
  sides.gate(kRerun, files, 1, "not decidable  models.physics");
  sides.gate(kRerun, files, 1, "another comparison, or other starts");
}

constexpr const char* kButton =
    "fluent On()\nfluent Broken()\nevent Press()\n!HoldsAt(On(),0).\n!HoldsAt(Broken(),0).\n"
    "[time] Initiates(Press(),On(),time).\n";

TEST_CASE("a property that is looked at for less long may be lost") {
  const TwoSides sides;
  const std::string breaks = "[time] HoldsAt(On(),time) -> Initiates(Press(),Broken(),time).\n";
  sides.put("a/m.e", std::string("range time 0 4\n") + kButton);
  sides.put("b/m.e", std::string("range time 0 1\n") + kButton + breaks);
  const std::string rules = "models: {properties: ['!HoldsAt(Broken(),time)']}\n";
  const std::vector<std::string> files = {"a/m.e", "b/m.e"};
  sides.gate(rules, files, 1, "holds up to timepoint 1, but a/m.e goes on to 4");
  sides.gate("models: {horizon: not-shorter}\n", files, 1,
             "broken         models.horizon: horizon 4 -> 1");
  sides.gate("models: {horizon: not-shorter}\n", {"b/m.e", "a/m.e"}, 0, "horizon 1 -> 4");
  sides.put("b/m.e", std::string("range time 0 4\n") + kButton + breaks);
  sides.gate(rules, files, 1, "broken         models.properties");
}

TEST_CASE("a plan that does not end any more keeps no promise about its end") {
  const TwoSides sides("two_models");
  sides.put("b/open_and_close.lisp",
            "(def-cram-function open-and-close ()\n"
            "  (loop (perform (an action (type parking-arms)))))\n(open-and-close)\n");
  const std::vector<std::string> files = {"a/agree.yaml", "b/agree.yaml"};
  sides.gate("models: {properties: ['eventually HoldsAt(Open(top),time)']}\n", files, 1,
             "not every execution ends by then");
  for (const std::string side : {"a", "b"}) {
    sides.put(side + "/suite.yaml",
              "cases:\n  - id: opens\n    model: agree.yaml\n"
              "    expect: {holds: 'eventually HoldsAt(Open(top),time)'}\n");
  }
  CHECK(sides.parallax({"suite", "a/suite.yaml"}).code == 0);
  const auto open = sides.parallax({"suite", "b/suite.yaml", "--json"});
  CHECK_MESSAGE(open.code == 1, open.out);
  CHECK_MESSAGE(says(open.out, "goes on beyond timepoint 3"), open.out);
}

TEST_CASE("a gate sees what a suite would run") {
  for (const std::string place : {"cases/agree.yaml", ".cases/agree.yaml", "cases/Agree.YAML"}) {
    CAPTURE(place);
    const TwoSides sides;
    for (const std::string side : {"a", "b"}) {
      const auto folder = sides.folder() / side / fs::path(place).parent_path();
      fs::copy(fs::path(PARALLAX_SOURCE_DIR) / "scenarios" / "two_models", folder,
               fs::copy_options::recursive);
      for (const auto* other : {"sticks.yaml", "unparks.yaml"}) fs::remove(folder / other);
      fs::rename(folder / "agree.yaml", sides.folder() / side / place);
      std::ofstream(folder / "report.json") << "{}\n";
      sides.put(side + "/other/lone.e", std::string("range time 0 1\n") + kButton);
    }
    sides.gate("models: {axioms: forbidden}\n", {"a", "b"}, 0, "scenarios and models changed");
    const auto model = fs::path(place).parent_path() / "opens.e";
    sides.replace("b/" + model.string(), "Initiates(OpenDrawer", "Terminates(OpenDrawer");
    sides.gate("models: {axioms: forbidden}\n", {"a", "b"}, 1,
               "broken         " + place + ": models.axioms");
  }
}

TEST_CASE("cases of manifests are held against the rules") {
  const TwoSides sides;
  sides.both("lamp.e", std::string("range time 0 2\n") + kButton);
  const auto manifest = [&](const std::string& side, const std::string& rest) {
    sides.put(side + "/suite.yaml", "cases:\n  - {id: a, model: lamp.e, " + rest + "}\n");
  };
  const std::string expects = "expect: {holds: '!HoldsAt(Broken(),time)'}";
  manifest("a", "horizon: 5, " + expects);
  manifest("b", "horizon: 5, " + expects);
  const std::string rules = "models: {lost_traces: forbidden, settings: forbidden}\n";
  sides.gate(rules, {"a", "b"}, 0, "no file of 1 scenario or model changed");
  // Traces that only the horizon of the case has.
  sides.put("b/lamp.e", sides.read("a/lamp.e") + "[time] time>=3 -> !Happens(Press(),time).\n");
  sides.gate(rules, {"a", "b"}, 1, "broken         suite.yaml:a: models.lost_traces");
  sides.put("b/lamp.e", sides.read("a/lamp.e"));
  manifest("b", "horizon: 1, " + expects);
  sides.gate("models: {horizon: not-shorter}\n", {"a", "b"}, 1,
             "broken         suite.yaml:a: models.horizon: horizon.a 5 -> 1");
  manifest("b", "horizon: 5, expect: {traces: 3}");
  sides.gate("models: {expect: forbidden}\n", {"a", "b"}, 1,
             "broken         suite.yaml:a: models.expect");
  sides.gate("models: {lost_traces: forbidden}\n", {"a", "b"}, 0,
             "suite.yaml:a: no rule is about expect.a");
  sides.put("b/suite.yaml", "cases:\n  - {id: other, model: lamp.e, " + expects + "}\n");
  sides.gate(rules, {"a", "b"}, 1, "not decidable  suite.yaml:a: the case is gone");
  fs::remove(sides.folder() / "b/suite.yaml");
  sides.gate(rules, {"a", "b"}, 1, "not decidable  suite.yaml: it is gone");
}

TEST_CASE("models of a case are compared as one") {
  const TwoSides sides;
  sides.both("names.e", "range time 0 2\nfluent On()\nevent Press()\n");
  sides.both("rules.e", "!HoldsAt(On(),0).\n[time] Initiates(Press(),On(),time).\n");
  sides.both("suite.yaml", "cases:\n  - {id: a, model: [names.e, rules.e], expect: {traces: 4}}\n");
  const std::string rules = "models: {lost_traces: forbidden, axioms: forbidden}\n";
  sides.gate(rules, {"a", "b"}, 0, "gate passed");
  sides.put("b/rules.e",
            "!HoldsAt(On(),0).\n[time] Initiates(Press(),On(),time).\n"
            "[time] !Happens(Press(),time).\n");
  sides.gate(rules, {"a", "b"}, 1, "broken         suite.yaml:a: models.lost_traces");
}

TEST_CASE("the program of a simulator is that beside each of two scenarios") {
  const TwoSides sides("two_regions");
  sides.both("own.yaml", "include: scenario.yaml\nsimulator: {command: [sh, sim.sh]}\n");
  sides.put("a/sim.sh", "exit 1\n");
  sides.put("b/sim.sh", "exit 2\n");
  const std::string rules = "models: {physics: forbidden}\n";
  sides.gate(rules, {"a/own.yaml", "b/own.yaml"}, 1, "simulator.command.files");
  ProcessOptions inside;
  inside.folder = (sides.folder() / "b").string();
  sides.gate(rules, {"../a/own.yaml", "own.yaml"}, 1, "simulator.command.files", inside);
  fs::remove(sides.folder() / "a/sim.sh");
  fs::remove(sides.folder() / "b/sim.sh");
  sides.gate(rules, {"a/own.yaml", "b/own.yaml"}, 0, "which was not found: it was not compared");
  sides.write("sim.sh", "exit 3\n");
  sides.gate(rules, {"a/own.yaml", "b/own.yaml"}, 0, "the same file for both sides");
}

TEST_CASE("fewer runs are weaker, also than the runs that a criterion takes by itself") {
  const TwoSides sides("two_models");
  const auto ask = [&](const std::string& side, const std::string& runs) {
    sides.put(side + "/own.yaml",
              "include: agree.yaml\ncriterion: {kind: clopper-pearson" + runs + "}\nexpect:\n");
  };
  const std::string rules = "models: {criterion: not-weaker}\n";
  ask("a", "");
  ask("b", ", runs: 5");
  sides.gate(rules, {"a/own.yaml", "b/own.yaml"}, 1, "broken         models.criterion");
  sides.gate(rules, {"b/own.yaml", "a/own.yaml"}, 0, "kept           models.criterion");
}

}  // namespace
}  // namespace parallax::test
