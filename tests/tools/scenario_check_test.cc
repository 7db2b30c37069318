// `parallax check SCENARIO` finds the faults that `parallax run` would find before its first
// simulation.

#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

/// Runs `check`, which leaves no run folder, and returns its messages.
std::string check(const CliFixture& cli, int code) {
  const auto result = cli.parallax({"check", "scenario.yaml"});
  CAPTURE(result.err);
  CHECK(result.code == code);
  CHECK_FALSE(std::filesystem::exists(cli.folder() / "out"));
  return result.err;
}

bool has(const std::string& text, const std::string& part) {
  CAPTURE(text);
  return text.find(part) != std::string::npos;
}

TEST_CASE("check of a sound scenario says nothing but its handlers that cannot run") {
  const CliFixture cli;
  CHECK(check(cli, 0) == "no errors\n");
}

TEST_CASE("check finds mappings that cannot be read, before anything is compiled twice") {
  const CliFixture cli;
  SUBCASE("a brace without a partner") {
    cli.replace("common.yaml", "Holding(): {flag: box.held}", "Holding(): {flag: \"{box.held\"}");
    CHECK(has(check(cli, 3), "error[E5133]: a `{` in `{box.held` has no partner"));
  }
  SUBCASE("a body that does not exist") {
    cli.replace("common.yaml", "RobotIn(region): {inside: region, body: robot}",
                "RobotIn(region): {inside: region, body: robt}");
    CHECK(has(check(cli, 3), "error[E5115]: the simulator has no variable `robt.x`"));
  }
}

TEST_CASE("check names ignored fluents that the model leaves open at the start") {
  const CliFixture cli;
  const auto domain = cli.read("domain.e"), common = cli.read("common.yaml");
  cli.write("domain.e", domain + "fluent Wet(region)\n");
  cli.replace("common.yaml", "Holding(): {flag: box.held}",
              "Holding(): {flag: box.held}\n  Wet(region): ignored");
  CHECK(has(check(cli, 0), "warning[W5309]: the model leaves `Wet(r1)` and 1 more of it open"));
  // Settled by an axiom about the start, or by compared fluents: nothing is open.
  for (const char* axiom : {"[region] !HoldsAt(Wet(region),0).",
                            "[region,time] HoldsAt(Wet(region),time) <-> "
                            "HoldsAt(BoxIn(region),time)."}) {
    CAPTURE(axiom);
    const std::string rest =
        std::string(axiom).find("<->") != std::string::npos ? "noninertial Wet\n" : "";
    cli.write("domain.e", domain + "fluent Wet(region)\n" + rest + axiom + "\n");
    CHECK(check(cli, 0).find("W5309") == std::string::npos);
  }
}

TEST_CASE("check names initial states that no start can be, and what never varies") {
  const CliFixture cli;
  const auto domain = cli.read("domain.e");
  // A lid that no part of the plan speaks of, and that the world never opens.
  cli.write("domain.e", domain + "fluent Lid()\n");
  cli.replace("common.yaml", "Holding(): {flag: box.held}",
              "Holding(): {flag: box.held}\n  Lid(): {start: box.x, above: 5.0}");
  const auto said = check(cli, 0);
  CHECK(has(said, "common.yaml:"));
  CHECK(has(said,
            "warning[W5311]: the model leaves `Lid()` open at timepoint 0, but no start has it "));
  CHECK_FALSE(has(said, "W5312"));
  // Settled by an axiom, or left out by the scenario.
  cli.write("domain.e", domain + "fluent Lid()\n!HoldsAt(Lid(),0).\n");
  CHECK_FALSE(has(check(cli, 0), "W5311"));
  cli.write("domain.e", domain + "fluent Lid()\n");
  const auto scenario = cli.read("scenario.yaml");
  cli.write("scenario.yaml", scenario + "\ninitial: first\n");
  CHECK_FALSE(has(check(cli, 0), "W5311"));
}

TEST_CASE("check names an initial state that no start can be though each fluent varies") {
  const CliFixture cli;
  // The box cannot lie on both sides at once, which the model does not know.
  cli.write("domain.e", cli.read("domain.e") + "fluent Far()\nfluent Near()\n");
  cli.replace("common.yaml", "Holding(): {flag: box.held}",
              "Holding(): {flag: box.held}\n  Far(): {start: box.x, above: 1.6}\n"
              "  Near(): {start: box.x, up_to: 1.4}");
  const auto said = check(cli, 0);
  CHECK(has(said, "common.yaml:"));
  CHECK(has(said,
            "warning[W5312]: no start of the world is the initial state with `Far()`, `Near()`: "
            "cannot draw a start state: "));
  CHECK_FALSE(has(said, "W5311"));
}

TEST_CASE("check warns of grips that the engine is known to let slip at the scenario's step") {
  const CliFixture cli;
  cli.replace("world.yaml", "    size_m: [0.07, 0.07, 0.07]\n    mass_kg: 0.3",
              "    ring: {diameter_m: 0.07, height_m: 0.07, wall_m: 0.008, sides: 8}\n"
              "    mass_kg: 0.6");
  const auto scenario = cli.read("scenario.yaml");
  const auto at_step = [&](const std::string& more) {
    cli.write("scenario.yaml", scenario + "\nworld: {include: world.yaml, " + more + "}\n");
    return check(cli, 0);
  };
  const auto said = at_step("solver: {timestep_s: 0.004}");
  CHECK(has(said, "world.yaml:"));
  CHECK(has(said,
            "warning[W5310]: at steps of 4 ms ode may let go of `box`, which is gripped as a ring: "
            "of grips that hold twice what they have to, 1 of 20 slipped at 4 ms"));
  CHECK(has(said,
            "help: Write `world: {solver: {timestep_s: 0.002}}`, at which none slipped, or "
            "`simulator: {engine: mujoco}`"));
  CHECK_FALSE(has(at_step("solver: {timestep_s: 0.002}"), "W5310"));
  // As light as this the grip holds more than five times what it has to.
  const std::string light = "solver: {timestep_s: 0.004}, bodies: {box: {mass_kg: 0.3}}";
  CHECK_FALSE(has(at_step(light), "W5310"));
  CHECK_FALSE(has(at_step("solver: {timestep_s: 0.004}, robot: {opening_m: 0.02}"), "W5310"));
  // A gentler squeeze of the action takes that away.
  cli.replace("common.yaml", "{controller: picking-up, object: box,",
              "{controller: picking-up, object: box, grip_force_n: 10,");
  CHECK(has(at_step(light), "W5310"));
}

TEST_CASE("check warns of cylinders in mujoco above a millisecond") {
  const CliFixture cli;
  cli.replace("world.yaml", "    size_m: [0.07, 0.07, 0.07]\n    mass_kg: 0.3",
              "    cylinder: {radius_m: 0.035, length_m: 0.07}\n    mass_kg: 0.6");
  CHECK_FALSE(has(check(cli, 0), "W5310"));  // ode
  cli.write("scenario.yaml", cli.read("scenario.yaml") + "\nsimulator: {engine: mujoco}\n");
  const auto said = cli.parallax({"check", "scenario.yaml"});
  CAPTURE(said.err);
  if (said.code == 3 && has(said.err, "E5145")) return;  // this build has no MuJoCo
  CHECK(said.code == 0);
  CHECK(has(said.err,
            "gripped as a cylinder: of grips that hold twice what they have to, 6 of 120 "
            "slipped at 2 ms"));
  CHECK(has(said.err, "`simulator: {engine: ode}`"));
}

TEST_CASE("check says which horizon would do where the plan needs a longer one") {
  const CliFixture cli;
  cli.replace("scenario.yaml", "horizon: 6", "horizon: 3");
  const auto said = check(cli, 0);
  CHECK(has(said, "warning[W7002]: no execution within 3 steps meets the state constraints"));
  CHECK(has(said, "note: the shortest way through the plan takes 4 performs"));
  CHECK(has(said, "note: a horizon of 4 is long enough"));
  const auto run = cli.parallax({"run", "scenario.yaml"});
  CHECK(has(run.err, "note: a horizon of 4 is long enough"));
}

TEST_CASE("check finds contradictory starts and constraints that nothing meets") {
  const CliFixture cli;
  SUBCASE("a model without an execution") {
    cli.write("start.e", cli.read("start.e") + "HoldsAt(RobotIn(r2),0).\n");
    CHECK(has(check(cli, 3), "error[E7001]"));
  }
  SUBCASE("a start that no continuous state stands for") {
    cli.write("start.e", cli.read("start.e") + "\nHoldsAt(Holding(),0).\n");
    const auto checked = cli.parallax({"check", "scenario.yaml"});
    const auto run = cli.parallax({"run", "scenario.yaml"});
    CHECK(checked.code == run.code);
    CHECK(checked.code == 3);
  }
  SUBCASE("constraints about what no event changes") {
    cli.write("domain.e", cli.read("domain.e") + "fluent Lit()\n!HoldsAt(Lit(),0).\n");
    cli.replace("common.yaml", "Holding(): {flag", "Lit(): ignored\n  Holding(): {flag");
    cli.replace("scenario.yaml", "HoldsAt(BoxIn(region),time))", "HoldsAt(Lit(),time))");
    const auto said = check(cli, 0);
    CHECK(has(said, "warning[W7002]"));
    CHECK(has(said, "note: no event that the plan performs has an effect on `Lit`"));
    CHECK(has(said, "note: no state that 6 timepoints of any events lead to meets them"));
  }
  SUBCASE("constraints that the plan does not come to, though events could") {
    cli.replace("scenario.yaml", "Happens(Place(region),time-1) & HoldsAt(BoxIn(region),time)",
                "region=r1 & HoldsAt(BoxIn(r2),time) & HoldsAt(Holding(),time-1)");
    const auto said = check(cli, 0);
    CHECK(has(said, "warning[W7002]"));
    CHECK_FALSE(has(said, "has an effect on"));
    CHECK_FALSE(has(said, "no state that"));
  }
  SUBCASE("no constraints") {
    const auto common = cli.read("common.yaml");
    const auto scenario = cli.read("scenario.yaml");
    const auto& file =
        common.find("constraints:") != std::string::npos ? "common.yaml" : "scenario.yaml";
    const auto text = cli.read(file);
    const auto begin = text.find("constraints:");
    REQUIRE(begin != std::string::npos);
    auto end = text.find('\n', begin) + 1;
    while (end < text.size() && (text[end] == ' ' || text[end] == '-'))
      end = text.find('\n', end) + 1;
    cli.write(file, text.substr(0, begin) + text.substr(end));
    CHECK(has(check(cli, 3), "error[E7004]: a run needs `constraints`"));
  }
}

TEST_CASE(
    "check puts the simulator into starts, and reports those that are all invalid as run does") {
  const CliFixture cli;
  std::string place;
  SUBCASE("one body in another") {
    cli.replace("common.yaml", "box.y: 0", "box.y: -0.6\n    box.x: 1.5\n    robot.x: 1.5");
    cli.replace("start.e", "RobotIn(r1)", "RobotIn(r2)");
    place =
        "common.yaml:11:5-6: error[E7105]: 100 starts in a row were invalid for sample 1 of "
        "trace 1: `base` overlaps `box` by";
  }
  SUBCASE("the robot beyond its range") {
    cli.replace("common.yaml", "r1: {x: [0, 1]}", "r1: {x: [-9, 1], start: {x: [-9, -8]}}");
    place =
        "common.yaml:10:5-6: error[E7105]: 100 starts in a row were invalid for sample 1 of "
        "trace 1: `robot` cannot stand at x = -8.";
  }
  const auto said = check(cli, 3);
  CHECK(has(said, place));
  const auto run = cli.parallax({"run", "scenario.yaml"});
  CHECK(run.code == 3);
  CHECK(run.err == said);
}

TEST_CASE("check tries starts of the other initial states too") {
  const CliFixture cli;
  // Beside the lane the box would lie in the base.
  cli.write("domain.e", cli.read("domain.e") + "fluent Beside()\n");
  cli.replace("common.yaml", "box.y: 0", "box.y: [-0.65, 0]\n    box.x: 1.5\n    robot.x: 1.5");
  cli.replace("common.yaml", "Holding(): {flag: box.held}",
              "Holding(): {flag: box.held}\n  Beside(): {start: box.y, up_to: -0.5}");
  cli.replace("start.e", "RobotIn(r1)", "RobotIn(r2)");
  CHECK(has(check(cli, 3), "error[E7105]: 100 starts in a row were invalid for sample 1"));
  cli.write("scenario.yaml", cli.read("scenario.yaml") + "\ninitial: first\n");
  check(cli, 0);
}

TEST_CASE("check of a scenario lints its model as check of the model does") {
  const CliFixture cli;
  cli.write("domain.e", cli.read("domain.e") + "fluent Lit()\n!HoldsAt(Lit(),0).\n");
  cli.replace("common.yaml", "Holding(): {flag", "Lit(): ignored\n  Holding(): {flag");
  const auto said = check(cli, 0);
  const auto model = cli.parallax({"check", "domain.e", "start.e", "--horizon", "6"});
  CHECK(has(said, "warning[W2101]: no event initiates, terminates or releases the fluent `Lit`"));
  CHECK(said == model.err);
  CHECK(cli.parallax({"check", "scenario.yaml", "--no-lint"}).err == "no errors\n");
  CHECK(cli.parallax({"check", "scenario.yaml", "--allow", "W2101"}).err == "no errors\n");
  // Only `check` reports it.
  CHECK_FALSE(has(cli.parallax({"run", "scenario.yaml"}).err, "W2101"));
}

TEST_CASE("a handler that no failure of its body comes to is reported where it stands") {
  const CliFixture cli;
  const auto plan = cli.read("fetch.lisp");
  const auto call = plan.rfind("(fetch");
  CAPTURE(plan);
  REQUIRE(call != std::string::npos);
  SUBCASE("because no perform has that class") {
    auto text = plan;
    text.insert(call, "(with-failure-handling ((perception-object-not-found (e) (return)))\n  ");
    text.insert(text.rfind(')') + 1, ")");
    cli.write("fetch.lisp", text);
    const auto said = check(cli, 0);
    CHECK(has(said,
              "warning[W-HANDLER]: the handler of `perception-object-not-found` can never run"));
    CHECK(has(said, "no perform in its body fails that way\n"));
  }
  SUBCASE("because the model never lets it fail") {
    auto text = plan;
    text.insert(call, "(with-failure-handling ((plan-failure (e) (return)))\n  ");
    text.insert(text.rfind(')') + 1, ")");
    cli.write("fetch.lisp", text);
    CHECK(has(check(cli, 0), "no perform in its body fails that way in the model\n"));
  }
  SUBCASE("not if the plan itself fails so") {
    auto text = plan;
    text.insert(call,
                "(with-failure-handling ((perception-object-not-found (e) (return)))\n"
                "  (fail 'perception-object-not-found)\n  ");
    text.insert(text.rfind(')') + 1, ")");
    cli.write("fetch.lisp", text);
    CHECK_FALSE(has(cli.parallax({"check", "scenario.yaml"}).err, "W-HANDLER"));
  }
}

TEST_CASE("a misspelt name is reported where it is misspelt, with the right one") {
  const CliFixture cli;
  const auto only = [&](const std::string& message) {
    const auto said = check(cli, 3);
    CHECK(has(said, message));
    const auto first = said.find(": error[");
    CHECK(said.find(": error[", first + 1) == std::string::npos);
    return said;
  };
  SUBCASE("a region of the scenario") {
    cli.replace("common.yaml", "r2: {x", "r3: {x");
    const auto said = only("common.yaml:11:5-6: error[E2101]: no constant `r3`");
    CHECK(has(said, "fetch.lisp:11:5-51: note: a pose of this perform lies in it"));
    CHECK(has(said, "fix: replace `r3` with `r1`"));
  }
  SUBCASE("an event of the binding table") {
    cli.replace("robot.bind", "PickUp()", "PikUp()");
    const auto said = only("robot.bind:5:");
    CHECK(has(said, "error[E3011]: the plan performs `PikUp`, which is no event of the model"));
    CHECK(has(said, "fix: replace `PikUp` with `PickUp`"));
  }
  SUBCASE("an event with another number of arguments") {
    cli.replace("robot.bind", "Place(region(?p))", "Place()");
    const auto said = only("robot.bind:7:");
    CHECK(has(said,
              "error[E3088]: the plan performs `Place` with no arguments, and the model declares "
              "it with 1 argument"));
    CHECK(has(said, "note: `Place(region)` declared here"));
  }
  SUBCASE("an object of the plan") {
    const auto plan = cli.read("fetch.lisp");
    const auto at = plan.rfind("(name box)");
    cli.write("fetch.lisp", plan.substr(0, at) + "(name bx)" + plan.substr(at + 10));
    const auto said = only("fetch.lisp:14: error[E5126]: `object` of `Place(r1)`: is `bx`");
    CHECK(has(said, "common.yaml:22:3-15: note: the plan's value goes to `placing` here"));
    CHECK(has(said, "fix: replace `bx` with `box`"));
  }
  SUBCASE("a time limit") {
    cli.replace("common.yaml", "going, time_limit_s", "going, time_limit");
    CHECK(has(only("error[E5121]"), "fix: replace `time_limit` with `time_limit_s`"));
  }
  SUBCASE("a sampled variable") {
    cli.replace("common.yaml", "box.yaw: 0", "box.ya: 0");
    only("common.yaml:27:5-10: error[E5115]: the simulator has no variable `box.ya`");
  }
  SUBCASE("a fluent of the model, used ten times") {
    cli.replace("domain.e", "fluent RobotIn(region)", "fluent RobotIm(region)");
    const auto said = only("error[E2101]: no fluent `RobotIn` of 1 argument(s)");
    CHECK(has(said, "note: it is used in 9 other places as well"));
    CHECK(has(said, "fix: replace `RobotIn` with `RobotIm`"));
  }
  SUBCASE("a fluent that cannot be called so") {
    cli.replace("domain.e", "fluent Holding()", "fluent holding()");
    CHECK(has(only("error[E1017]: `holding` cannot name a fluent"),
              "fix: replace `holding` with `Holding`"));
  }
  SUBCASE("a sort, on which declarations and formulas depend") {
    cli.replace("domain.e", "sort region", "sort regio");
    CHECK(has(only("domain.e:5:1-6: error[E2001]: no sort `region`"),
              "fix: replace `region` with `regio`"));
  }
  SUBCASE("a tab") {
    cli.replace("common.yaml", "  include: world.yaml", "\tinclude: world.yaml");
    CHECK(has(only("common.yaml:5:1: error[E5101]: the YAML text cannot be read: a line is "
                   "indented with a tab"),
              "help: Indent with blanks."));
  }
}

TEST_CASE("check does not start the commands of other simulators, and says so") {
  const CliFixture cli;
  cli.write("scenario.yaml",
            cli.read("scenario.yaml") + "\nsimulator: {command: [touch, started]}\n");
  const auto result = cli.parallax({"check", "scenario.yaml"});
  CAPTURE(result.err);
  CHECK(has(result.err, "the simulator was not started"));
  CHECK_FALSE(std::filesystem::exists(cli.folder() / "started"));
}

}  // namespace
}  // namespace parallax::test
