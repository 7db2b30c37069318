// `parallax learn` in worlds that contradict a model's axioms about states, and in which chance
// decides the effects of events. The worlds are models; the learned model is compared with them by
// `parallax diff`.

#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

/// Traces that the learned scenario OUT has and `truth` lacks, and the other way round.
struct Traces {
  Json lost, gained;
};
Traces traces(const CliFixture& cli, const std::string& truth, const std::string& out) {
  const auto result =
      cli.parallax({"diff", truth, out + "/learned.yaml", "--json", "--allow-outside"});
  CAPTURE(result.err);
  REQUIRE(Json::accept(result.out));
  const auto found = Json::parse(result.out).at("traces");
  return {found.at("lost"), found.at("gained")};
}

/// A camera looks along three cells for a cup. It sees things that lie where it looks; the world's
/// camera also sees those on the next cell.
class CameraWorld : public CliFixture {
 public:
  CameraWorld() {
    write("words.e",
          "sort cell\nsort item\ncell left, middle, right\nitem cup\n"
          "predicate Beside(cell,cell)\n"
          "fluent LookingAt(cell)\nfluent At(item,cell)\nfluent Seen(item)\nfluent Visible(item)\n"
          "noninertial Visible\n"
          "event Look(cell)\nevent Detect(item)\n"
          "[cell1,cell2] Beside(cell1,cell2) <->\n"
          "  cell1=left & cell2=middle | cell1=middle & cell2=left |\n"
          "  cell1=middle & cell2=right | cell1=right & cell2=middle.\n"
          "[cell1,cell2,time] HoldsAt(LookingAt(cell1),time) & HoldsAt(LookingAt(cell2),time) ->\n"
          "  cell1=cell2.\n"
          "[item,cell1,cell2,time] HoldsAt(At(item,cell1),time) & HoldsAt(At(item,cell2),time) ->\n"
          "  cell1=cell2.\n"
          "[item,time] {cell} HoldsAt(At(item,cell),time).\n"
          "[cell,time] Initiates(Look(cell),LookingAt(cell),time).\n"
          "[cell1,cell2,time] cell1!=cell2 -> Terminates(Look(cell1),LookingAt(cell2),time).\n"
          "[item,time] HoldsAt(Visible(item),time) -> Initiates(Detect(item),Seen(item),time).\n");
    const std::string looks = "HoldsAt(LookingAt(cell1),time) & HoldsAt(At(item,cell2),time)";
    camera("narrow.e", looks + " & cell1=cell2");
    camera("wide.e", looks + " & (cell1=cell2 | Beside(cell1,cell2))");
    camera("dim.e", looks + " & cell1=cell2 & HoldsAt(Bright(),time)");
    write("dim.e", "fluent Bright()\nnoninertial Bright\n" + read("dim.e"));
    write("start.e", "[cell] !HoldsAt(LookingAt(cell),0).\n[item] !HoldsAt(Seen(item),0).\n");
    write("find.lisp",
          "(defun find-cup ()\n"
          "  (dolist (?cell '(:left :middle :right))\n"
          "    (perform (an action (type looking) (object (an object (name ?cell)))))\n"
          "    (cpl:with-failure-handling\n"
          "        ((common-fail:perception-low-level-failure (e) (return)))\n"
          "      (return-from find-cup\n"
          "        (perform (an action (type detecting) (object (an object (name cup)))))))))\n"
          "(def-cram-function look-around () (find-cup))\n(look-around)\n");
    write("robot.bind",
          "action looking (:object name ?c) -> Look(?c)\n"
          "    ok: LookingAt(?c) @t+1 else ptu-goal-unreachable\n"
          "action detecting (:object name ?o) -> Detect(?o)\n"
          "    ok: Visible(?o) @t else perception-object-not-found\n");
  }

  /// A scenario with the given world and model.
  void scenario(const std::string& name, const std::string& model, const std::string& world,
                const std::string& more = "") const {
    write(name, more +
                    "plan: find.lisp\nbind: robot.bind\nhorizon: 7\n"
                    "constraints: \"{item} HoldsAt(Seen(item),time)\"\n"
                    "model: [" +
                    model + ", start.e]\nsimulator: {model: " + world + "}\n");
  }

 private:
  void camera(const std::string& name, const std::string& condition) const {
    write(name, "load words.e\n[item,time] HoldsAt(Visible(item),time) <-> ({cell1,cell2} " +
                    condition + ").\n");
  }
};

TEST_CASE("half of a definition that runs contradict gets exceptions, and is named with the runs") {
  const CameraWorld cli;
  cli.scenario("own.yaml", "narrow.e", "wide.e");
  const auto report = json_of(cli, {"learn", "own.yaml", "--out", "out"});
  CHECK(report.at("clean") == true);
  CHECK(report.at("runs") == report.at("runs_admitted"));
  // Traces with one initial state and with two are claimed in other words.
  CHECK(report.at("claims").size() == 2);
  REQUIRE(report.at("contradicted_formulas").size() == 1);
  const auto& told = report.at("contradicted_formulas").at(0);
  CHECK(told.at("place").get<std::string>().starts_with("narrow.e:2"));
  // The other half stands: an item where the camera looks is visible.
  CHECK(told.at("formula").get<std::string>().starts_with(
      "[item,time] HoldsAt(Visible(item),time) ->"));
  CHECK(!told.at("runs").empty());
  CHECK(report.at("model").get<std::string>().find("contradicted by runs") != std::string::npos);
  CHECK(cli.parallax({"check", "out/learned.e", "--horizon", "3"}).code == 0);
  CHECK(cli.parallax({"run", "out/learned.yaml", "--allow-outside", "--out", "again"}).code == 0);
  cli.scenario("truth.yaml", "wide.e", "wide.e", "execution: closed-loop\n");
  const auto found = traces(cli, "truth.yaml", "out");
  CHECK(found.lost.at("answer") == "none");
  // The learned exceptions are as certain as the definition itself: no trace is gained.
  CHECK(found.gained.at("answer") == "none");
}

TEST_CASE(
    "each half of a definition is refuted by itself, and chance gets no exceptions one by one") {
  const CameraWorld cli;
  // An item where the camera looks is seen or not, by chance.
  cli.scenario("own.yaml", "narrow.e", "dim.e");
  const auto report = json_of(cli, {"learn", "own.yaml", "--out", "out"});
  CHECK(report.at("clean") == true);
  CHECK(report.at("runs") == report.at("runs_admitted"));
  REQUIRE(report.at("contradicted_formulas").size() == 1);
  const auto told = report.at("contradicted_formulas").at(0);
  CHECK(told.at("formula").get<std::string>().ends_with("-> HoldsAt(Visible(item),time)."));
  // All of it: no cell is distinguished from another.
  const auto instead = told.at("instead").get<std::string>();
  CAPTURE(instead);
  CHECK(instead.starts_with("[item,time] time=0 -> "));
  // The other half stands: an item where the camera does not look is never visible.
  CHECK(report.at("model").get<std::string>().find("HoldsAt(Visible(item),time) ->") !=
        std::string::npos);
}

TEST_CASE("a definition that the world agrees with stays as it is") {
  const CameraWorld cli;
  cli.scenario("own.yaml", "wide.e", "wide.e");
  const auto report = json_of(cli, {"learn", "own.yaml", "--out", "out"});
  CHECK(report.at("clean") == true);
  CHECK(report.at("judged_in_closed_loop") == false);
  CHECK(report.at("contradicted_formulas").empty());
  const auto found = traces(cli, "own.yaml", "out");
  CHECK(found.lost.at("answer") == "none");
  CHECK(found.gained.at("answer") == "none");
}

/// A robot drives from the counter to the table, past drawers that may be open and things that lie
/// here or there. In the world the lowest drawer, when open, stops it or does not.
class DriveWorld : public CliFixture {
 public:
  DriveWorld() {
    write("words.e",
          "sort base\nsort cell\nsort drawer\nsort item\n"
          "base work, table\ncell cl, cm, cr\ndrawer upper, middle, lower\nitem cup, bowl, milk\n"
          "fluent RobotAt(base)\nfluent At(item,cell)\nfluent Open(drawer)\nevent Go(base)\n"
          "[base1,base2,time] HoldsAt(RobotAt(base1),time) & HoldsAt(RobotAt(base2),time) ->\n"
          "  base1=base2.\n"
          "[time] {base} HoldsAt(RobotAt(base),time).\n"
          "[item,cell1,cell2,time] HoldsAt(At(item,cell1),time) & HoldsAt(At(item,cell2),time) ->\n"
          "  cell1=cell2.\n"
          "[item,time] {cell} HoldsAt(At(item,cell),time).\n");
    const std::string open = "HoldsAt(Open(lower),time)";
    write("free.e", "load words.e\n" + arriving(""));
    write("world.e", "load words.e\nfluent Lucky()\nnoninertial Lucky\n" +
                         arriving("(!" + open + " | HoldsAt(Lucky(),time)) & "));
    write("start.e", "HoldsAt(RobotAt(work),0).\n");
    write("go.lisp",
          "(def-cram-function go-there ()\n"
          "  (perform (an action (type going) (object (an object (name table))))))\n(go-there)\n");
    write("robot.bind",
          "action going (:object name ?b) -> Go(?b)\n"
          "    ok: RobotAt(?b) @t+1 else navigation-pose-unreachable\n");
    scenario("own.yaml", "free.e", "");
    scenario("truth.yaml", "world.e", "execution: closed-loop\n");
  }

 private:
  static std::string arriving(const std::string& condition) {
    return "[base,time] " + condition + "base=base -> Initiates(Go(base),RobotAt(base),time).\n" +
           "[base1,base2,time] " + condition +
           "base1!=base2 -> Terminates(Go(base1),RobotAt(base2),time).\n";
  }
  void scenario(const std::string& name, const std::string& model, const std::string& more) const {
    write(name, more +
                    "plan: go.lisp\nbind: robot.bind\nhorizon: 2\n"
                    "constraints: \"HoldsAt(RobotAt(table),time)\"\n"
                    "model: [" +
                    model + ", start.e]\nsimulator: {model: world.e}\n");
  }
};

TEST_CASE("chance that depends on the state: its condition is found, and rounds come to an end") {
  const DriveWorld cli;
  const auto report = json_of(cli, {"learn", "own.yaml", "--out", "out"});
  CHECK(report.at("clean") == true);
  CHECK(report.at("runs") == report.at("runs_admitted"));
  CHECK(report.at("judged_in_closed_loop") == true);
  // There are 216 initial states; nothing is stated about a single one of them.
  CHECK(report.at("axioms").get<int>() <= 6);
  const auto found = traces(cli, "truth.yaml", "out");
  CAPTURE(cli.read("out/learned.e"));
  CHECK(found.lost.at("answer") == "none");
  CHECK(found.gained.at("answer") == "none");
  CHECK(cli.parallax({"run", "out/learned.yaml", "--allow-outside", "--out", "again"}).code == 0);
  // A case that was observed both ways is named once for each way.
  CHECK(!report.at("contradictions").empty());
}

/// The same, with a gaze that is lost where the robot arrives, or by a chance of its own.
class GazeWorld : public DriveWorld {
 public:
  explicit GazeWorld(const std::string& lost_where) {
    write("words.e", read("words.e") + "fluent Gaze(cell)\n" +
                         "[cell1,cell2,time] HoldsAt(Gaze(cell1),time) & " +
                         "HoldsAt(Gaze(cell2),time) -> cell1=cell2.\n");
    write("start.e", read("start.e") + "[item] item!=milk -> HoldsAt(At(item,cl),0).\n" +
                         "HoldsAt(At(milk,cr),0).\n!HoldsAt(Open(upper),0).\n");
    write("world.e", read("world.e") + "fluent Tired()\nnoninertial Tired\n" +
                         "[base,cell,time] (!HoldsAt(Open(lower),time) | " + lost_where +
                         ") -> Terminates(Go(base),Gaze(cell),time).\n");
  }
};

TEST_CASE("outcomes that one chance decides are opened together, and others by themselves") {
  const std::string one_chance = "HoldsAt(Lucky(),time)";
  for (const auto& lost : {one_chance, std::string("HoldsAt(Tired(),time)")}) {
    const GazeWorld cli(lost);
    const auto report = json_of(cli, {"learn", "own.yaml", "--out", "out"});
    CAPTURE(cli.read("out/learned.e"));
    CHECK(report.at("clean") == true);
    CHECK(report.at("runs") == report.at("runs_admitted"));
    const auto found = traces(cli, "truth.yaml", "out");
    CHECK(found.lost.at("answer") == "none");
    // By itself a gaze that may be lost is also lost where the robot arrives for certain.
    if (lost == one_chance) CHECK(found.gained.at("answer") == "none");
    const auto model = report.at("model").get<std::string>();
    CHECK((model.find("One chance decides both, as in runs ") != std::string::npos) ==
          (lost == one_chance));
  }
}

TEST_CASE("what chance has decided stays so while other things happen") {
  const DriveWorld cli;
  cli.write("words.e", cli.read("words.e") +
                           "fluent Bell()\nevent Ring()\nevent Hush()\n"
                           "[time] Initiates(Ring(),Bell(),time).\n"
                           "[time] Terminates(Hush(),Bell(),time).\n");
  cli.write("start.e", cli.read("start.e") + "!HoldsAt(Bell(),0).\n");
  cli.write("robot.bind", cli.read("robot.bind") +
                              "action ringing () -> Ring()\n"
                              "    ok: Bell() @t+1 else manipulation-goal-not-reached\n"
                              "action hushing () -> Hush()\n"
                              "    ok: !Bell() @t+1 else manipulation-goal-not-reached\n");
  cli.write(
      "go.lisp",
      "(def-cram-function go-there ()\n"
      "  (cpl:with-failure-handling ((common-fail:navigation-low-level-failure (e) (return)))\n"
      "    (perform (an action (type going) (object (an object (name table))))))\n"
      "  (perform (an action (type ringing)))\n"
      "  (perform (an action (type hushing))))\n(go-there)\n");
  for (const std::string name : {"own.yaml", "truth.yaml"}) {
    cli.replace(name, "horizon: 2", "horizon: 4");
  }
  const auto report = json_of(cli, {"learn", "own.yaml", "--out", "out"});
  CHECK(report.at("clean") == true);
  CHECK(report.at("runs") == report.at("runs_admitted"));
  CHECK(report.at("judged_in_closed_loop") == true);
  const auto found = traces(cli, "truth.yaml", "out");
  CAPTURE(cli.read("out/learned.e"));
  CHECK(found.lost.at("answer") == "none");
  CHECK(found.gained.at("answer") == "none");
  // It is a model like any other.
  CHECK(cli.parallax({"check", "out/learned.yaml", "--allow-outside"}).code == 0);
  CHECK(cli.parallax({"run", "out/learned.yaml", "--allow-outside", "--out", "again"}).code == 0);
}

TEST_CASE("what is learned where chance decides does not depend on jobs") {
  const DriveWorld cli;
  const auto one = json_of(cli, {"learn", "own.yaml", "--out", "a", "--seed", "5"});
  const auto two = json_of(cli, {"learn", "own.yaml", "--out", "b", "--seed", "5", "--jobs", "2"});
  CHECK(one.at("model") == two.at("model"));
  CHECK(one.at("rounds") == two.at("rounds"));
}

TEST_CASE("a formula that is no definition goes where runs contradict it, but for the start") {
  const CliFixture cli;
  const std::string words =
      "sort cell\nsort item\ncell shelf, ledge\nitem cup\n"
      "fluent At(item,cell)\nfluent Held(item)\nevent Take(item)\nevent Put(item,cell)\n"
      "[item,cell1,cell2,time] HoldsAt(At(item,cell1),time) & HoldsAt(At(item,cell2),time) ->\n"
      "  cell1=cell2.\n"
      "[item,time] Initiates(Take(item),Held(item),time).\n"
      "[item,cell,time] Terminates(Take(item),At(item,cell),time).\n"
      "[item,cell,time] Terminates(Put(item,cell),Held(item),time).\n";
  cli.write("model.e", words +
                           "[item,time] {cell} HoldsAt(At(item,cell),time) | "
                           "HoldsAt(Held(item),time).\n"
                           "[item,cell,time] Initiates(Put(item,cell),At(item,cell),time).\n");
  // An item that is put on the ledge falls.
  cli.write("world.e", words +
                           "[item,cell,time] cell!=ledge -> "
                           "Initiates(Put(item,cell),At(item,cell),time).\n");
  cli.write("start.e", "[item] !HoldsAt(Held(item),0).\n");
  cli.write("put.lisp",
            "(def-cram-function put-there ()\n"
            "  (perform (an action (type taking) (object (an object (name cup)))))\n"
            "  (perform (an action (type putting) (object (an object (name cup)))\n"
            "                      (target (an object (name ledge))))))\n(put-there)\n");
  cli.write("robot.bind",
            "action taking (:object name ?o) -> Take(?o)\n"
            "    ok: Held(?o) @t+1 else manipulation-pose-unreachable\n"
            "action putting (:object name ?o :target name ?c) -> Put(?o,?c)\n"
            "    ok: At(?o,?c) @t+1 else manipulation-goal-not-reached\n");
  const std::string common =
      "plan: put.lisp\nbind: robot.bind\nhorizon: 3\n"
      "constraints: \"{item,cell} Happens(Put(item,cell),time-1)\"\nsimulator: {model: world.e}\n";
  cli.write("own.yaml", common + "model: [model.e, start.e]\n");
  const auto report = json_of(cli, {"learn", "own.yaml", "--out", "out"});
  CHECK(report.at("clean") == true);
  CHECK(report.at("judged_in_closed_loop") == false);
  CHECK(report.at("runs") == report.at("runs_admitted"));
  REQUIRE(report.at("contradicted_formulas").size() == 1);
  const auto& told = report.at("contradicted_formulas").at(0);
  CHECK(told.at("place").get<std::string>().starts_with("model.e:"));
  CHECK(told.at("instead").get<std::string>().find("time=0 -> ") != std::string::npos);
  // The start is unchanged: the cup is somewhere.
  cli.write("truth.e", words +
                           "[item] {cell} HoldsAt(At(item,cell),0) | HoldsAt(Held(item),0).\n"
                           "[item,cell,time] cell!=ledge -> "
                           "Initiates(Put(item,cell),At(item,cell),time).\n");
  cli.write("truth.yaml", common + "model: [truth.e, start.e]\n");
  const auto found = traces(cli, "truth.yaml", "out");
  CAPTURE(cli.read("out/learned.e"));
  CHECK(found.lost.at("answer") == "none");
  CHECK(found.gained.at("answer") == "none");
  const auto told_so = cli.parallax({"learn", "own.yaml", "--out", "again"});
  CHECK(told_so.err.find("formula contradicted by runs ") != std::string::npos);
}

}  // namespace
}  // namespace parallax::test
