// Models that are wrong in every run, but right about its end: every step is compared.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"
#include "tests/tools/kitchen_copy.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

/// Driving is as it is; the effects of picking up and placing are for the model to say.
constexpr const char* kDriving =
    "sort region\nregion r1, r2\n"
    "fluent RobotIn(region)\nfluent BoxIn(region)\nfluent Holding()\nfluent Grasped()\n"
    "event Go(region)\nevent PickUp()\nevent Place(region)\n"
    "[region,time] Initiates(Go(region),RobotIn(region),time).\n"
    "[region1,region2,time] region1!=region2 -> Terminates(Go(region1),RobotIn(region2),time).\n"
    "HoldsAt(RobotIn(r1),0). !HoldsAt(RobotIn(r2),0).\n"
    "HoldsAt(BoxIn(r2),0). !HoldsAt(BoxIn(r1),0). !HoldsAt(Holding(),0). !HoldsAt(Grasped(),0).\n";

constexpr const char* kPlacing =
    "[region,time] Initiates(Place(region),BoxIn(region),time).\n"
    "[region1,region2,time] region1!=region2 -> Terminates(Place(region1),BoxIn(region2),time).\n"
    "[region,time] Terminates(Place(region),Holding(),time).\n";

/// A scenario of its own with this model; `ok`: the plan's condition for a successful pick-up.
void write_scenario(const CliFixture& cli, const std::string& model, const std::string& ok,
                    const std::string& plan = "fetch.lisp") {
  cli.write("own.e", kDriving + model);
  cli.replace("robot.bind", "ok: Holding() @t+1", "ok: " + ok + " @t+1");
  cli.write("own.yaml", "include: common.yaml\nmodel: own.e\nplan: " + plan +
                            "\nbind: robot.bind\nhorizon: 6\n"
                            "constraints: \"{region} Happens(Place(region),time-1)\"\n"
                            "mapping: {Grasped(): {ignored: the model's own bookkeeping}}\n");
}

/// The discrepancy of the first run, which is one from every start and is gone at its end.
Json transient(const CliFixture& cli) {
  const auto report = json_of(cli, {"run", "own.yaml", "--out", "out"}, 1);
  CHECK(report.at("compare") == "every-step");
  CHECK(report.at("simulations") == 1);
  const auto& found = report.at("discrepancies").at(0);
  CHECK(found.at("kind") == "transient");
  CHECK(found.at("fluents").empty());

  const auto rates = json_of(cli, {"rates", "own.yaml", "--runs", "5"});
  CHECK(rates.at("compare") == "every-step");
  CHECK(rates.at("traces").at(0).at("any").at("count") == 5);
  // A comparison of the last state only sees nothing, and the report says so.
  const auto last =
      json_of(cli, {"run", "own.yaml", "--compare", "final", "--epsilon", "0.4", "--out", "last"});
  CHECK(last.at("compare") == "final");
  CHECK(last.at("verdict") == "no-discrepancy");
  CHECK(last.at("traces").at(0).at("strayed") == last.at("simulations"));
  cli.write("final.yaml", "include: own.yaml\ncompare: final\n");
  CHECK(json_of(cli, {"run", "final.yaml", "--epsilon", "0.4", "--out", "final"}).at("verdict") ==
        "no-discrepancy");
  // A run is continued with the comparison that it began with.
  const auto other =
      cli.parallax({"run", "own.yaml", "--epsilon", "0.4", "--out", "last", "--resume", "--json"});
  CHECK(other.code == 3);
  CHECK(other.out.find("E7102") != std::string::npos);
  return found;
}

TEST_CASE("an effect that the model forgets") {
  const CliFixture cli;
  write_scenario(cli, std::string("[time] Initiates(PickUp(),Holding(),time).\n") + kPlacing,
                 "Holding()");
  const auto found = transient(cli);
  CHECK(found.at("first_divergence") == 2);
  const Json forgotten = {{"fluent", "BoxIn(r2)"},
                          {"timepoint", 2},
                          {"predicted", true},
                          {"observed", false},
                          {"measured", "box.held = true"}};
  CHECK(found.at("first") == Json::array({forgotten}));
  CHECK(found.at("cause").at("text") == "PickUp(): not BoxIn(r2)");
  const auto text = cli.read("out/report.txt");
  CHECK(text.find("first seen at timepoint 2, after PickUp() (fetch.lisp:12): BoxIn(r2) is false "
                  "instead of true\n") != std::string::npos);
  CHECK(text.find("not compared Grasped(): the model's own bookkeeping") != std::string::npos);
  // It is repeated and explained as any other.
  CHECK(cli.parallax({"replay", "out"}).code == 0);
  const auto why = cli.parallax({"explain", "out"});
  CHECK(why.code == 1);
  CHECK(why.out.find("inertia of BoxIn(region)") != std::string::npos);
}

TEST_CASE("an effect that comes one step late") {
  const CliFixture cli;
  write_scenario(cli,
                 std::string("[time] Initiates(PickUp(),Grasped(),time).\n"
                             "[region,time] Terminates(PickUp(),BoxIn(region),time).\n"
                             "[region,time] HoldsAt(Grasped(),time) -> "
                             "Initiates(Go(region),Holding(),time).\n") +
                     kPlacing,
                 "Grasped()");
  const auto found = transient(cli);
  CHECK(found.at("first_divergence") == 2);
  CHECK(found.at("cause").at("text") == "PickUp(): Holding()");
}

TEST_CASE("an effect that is undone later") {
  const CliFixture cli;
  cli.write("back.lisp",
            "(let ((?there (make-pose-stamped \"map\" 0 (make-3d-vector 1.5 0 0) "
            "(make-identity-rotation))))\n"
            "  (perform (a motion (type going) (pose ?there)))\n"
            "  (perform (an action (type picking-up) (object (an object (name box)))))\n"
            "  (perform (an action (type placing) (object (an object (name box)))\n"
            "           (target (a location (pose ?there))))))\n");
  // Neither picking up nor placing does anything.
  write_scenario(cli, "", "BoxIn(r2)", "back.lisp");
  const auto found = transient(cli);
  CHECK(found.at("first_divergence") == 2);
  CHECK(found.at("first").size() == 2);
  CHECK(found.at("cause").at("text") == "PickUp(): not BoxIn(r2)");
}

TEST_CASE("the kitchen's model without what opening a drawer does to the arm") {
  const KitchenCopy cli;
  cli.replace("kitchen/common.e", "    Terminates(OpenDrawer(arm,drawer),Parked(arm),time).\n",
              "    Initiates(OpenDrawer(arm,drawer),DrawerOpen(drawer),time).\n");
  const auto report = json_of(cli, {"run", "kitchen/plan3.yaml", "--out", "out"}, 1);
  const auto& found = report.at("discrepancies").at(0);
  CHECK(found.at("sample") == 1);
  CHECK(found.at("cause").at("text") == "OpenDrawer(left,dTop): not Parked(left)");
}

TEST_CASE("where last states are compared the cause is one that the last state shows") {
  const CliFixture cli;
  // Odd() differs from picking up to placing in every run, and never in the end.
  cli.write("odd.e", cli.read("domain.e") +
                         "fluent Odd()\n[time] Initiates(PickUp(),Odd(),time).\n"
                         "[region,time] Terminates(Place(region),Odd(),time).\n"
                         "!HoldsAt(Odd(),0).\n");
  cli.write("odd.yaml",
            "include: edge.yaml\nmodel: [odd.e, start.e]\n"
            "mapping: {Odd(): {range: robot.x, holds: [5, 6], fails: [-5, 4.9]}}\n");
  const auto causes = [&](const std::string& comparison) {
    const auto rates = json_of(cli, {"rates", "odd.yaml", "--runs", "6", "--compare", comparison});
    return rates.at("traces").at(0).at("causes");
  };
  REQUIRE_FALSE(causes("final").empty());
  for (const auto& cause : causes("final")) CHECK(cause.at("cause") == "Place(r1): not BoxIn(r1)");
  REQUIRE(causes("every-step").size() == 1);
  CHECK(causes("every-step").at(0).at("cause") == "PickUp(): not Odd()");
  // A claim about every step says which fluents it leaves out on the way.
  cli.replace("odd.yaml", "fails: [-5, 4.9]}", "fails: [-5, 4.9], compare: final}");
  const auto report = json_of(cli, {"run", "odd.yaml", "--seed", "3", "--out", "odd"}, 1);
  const auto caveats = report.at("traces").at(0).at("caveats").dump();
  CHECK(caveats.find("compared at the start and in the last state only: Odd()") !=
        std::string::npos);
}

TEST_CASE("what is no comparison is refused at its place") {
  const CliFixture cli;
  cli.write("odd.yaml", "include: edge.yaml\ncompare: sometimes\n");
  const auto odd = cli.parallax({"check", "odd.yaml"});
  CHECK(odd.code == 3);
  CHECK(odd.err.find("odd.yaml:2:10") != std::string::npos);
  CHECK(odd.err.find("every-step") != std::string::npos);
  cli.write("odder.yaml",
            "include: edge.yaml\nmapping: {Holding(): {flag: box.held, compare: rarely}}\n");
  const auto odder = cli.parallax({"check", "odder.yaml"});
  CHECK(odder.code == 3);
  CHECK(odder.err.find("odder.yaml:2:") != std::string::npos);
}

}  // namespace
}  // namespace parallax::test
