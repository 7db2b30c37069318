// `parallax explain`: why a model has no trace, and why a fact holds in one.

#include <doctest/doctest.h>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

constexpr const char* kClash =
    "range time 0 2\nfluent F()\nfluent G()\nevent E()\n"
    "HoldsAt(G(),0).\n"                  // line 5, innocent
    "HoldsAt(F(),0).\n"                  // line 6
    "[time] Initiates(E(),G(),time).\n"  // line 7, innocent
    "!HoldsAt(F(),2).\n";                // line 8

TEST_CASE("the axioms that contradict each other are named with their instances and a proof") {
  const CliFixture cli;
  cli.write("m.e", kClash);
  const auto result = cli.parallax({"explain", "m.e"});
  CHECK(result.code == 1);
  CHECK(result.err == "");
  CHECK(result.out ==
        "The model has no trace; 1 minimal set of axioms that contradict each other (no fewer "
        "axioms do):\n"
        "set 1: 3 axioms (proof checked)\n"
        "  m.e:2  inertia of F()\n"
        "      HoldsAt(F(),0) -> HoldsAt(F(),1)\n"
        "      HoldsAt(F(),1) -> HoldsAt(F(),2)\n"
        "  m.e:6  HoldsAt(F(),0)\n"
        "      HoldsAt(F(),0)\n"
        "  m.e:8  !HoldsAt(F(),2)\n"
        "      !HoldsAt(F(),2)\n");
  const auto json = json_of(cli, {"explain", "m.e"}, 1);
  CHECK(json["satisfiable"] == false);
  CHECK(json["smallest"] == true);
  CHECK(json["sets"][0]["proof"] == "checked");
  CHECK(json["sets"][0]["axioms"][2]["line"] == 8);
  CHECK(json["sets"][0]["axioms"][2]["instances"][0] == "!HoldsAt(F(),2)");
}

TEST_CASE("--all names every minimal set, --limit fewer") {
  const CliFixture cli;
  cli.write("m.e", std::string(kClash) + "!HoldsAt(F(),0).\n");
  const auto all = cli.parallax({"explain", "m.e", "--all"});
  CHECK(all.code == 1);
  CHECK(holds(all.out, "2 minimal sets of axioms that contradict each other (these are all "));
  CHECK(holds(all.out, "set 1: 2 axioms"));
  CHECK(holds(all.out, "set 2: 3 axioms"));
  const auto json = json_of(cli, {"explain", "m.e", "--all", "--limit", "1"}, 1);
  CHECK(json["sets"].size() == 1);
  CHECK(json["complete"] == false);
}

TEST_CASE("a model with traces has nothing to explain, and a compiled model is explained as well") {
  const CliFixture cli;
  cli.write("m.e", "range time 0 1\nfluent F()\nHoldsAt(F(),0).\n");
  const auto fine = cli.parallax({"explain", "m.e"});
  CHECK(fine.code == 0);
  CHECK(holds(fine.out, "do not contradict each other"));
  cli.write("clash.e", kClash);
  REQUIRE(cli.parallax({"compile", "clash.e", "-o", "clash.dec.cnf"}).code == 0);
  const auto compiled = cli.parallax({"explain", "clash.dec.cnf"});
  CHECK(compiled.code == 1);
  CHECK(holds(compiled.out, "  clash.e:8  !HoldsAt(F(),2)"));
}

TEST_CASE("a state constraint that no trace meets takes part") {
  const CliFixture cli;
  cli.write("m.e", "range time 0 3\nfluent F()\nevent E()\n!HoldsAt(F(),0).\n");
  const auto result = cli.parallax({"explain", "m.e", "--until", "HoldsAt(F(),time)"});
  CHECK(result.code == 1);
  CHECK(holds(result.out, "m.e:4  !HoldsAt(F(),0)"));
  CHECK(holds(result.out, "HoldsAt(F(),time)"));
  CHECK(cli.parallax({"explain", "m.e", "--until", "!HoldsAt(F(),time)"}).code == 0);
}

constexpr const char* kCup =
    "range time 0 4\nsort thing\nthing Cup\nfluent Filled(thing)\nfluent Holding()\n"
    "event Grasp()\nevent Pour(thing)\nevent Spill(thing)\n"
    "[time] Initiates(Grasp(),Holding(),time).\n"  // line 9
    "[thing,time] HoldsAt(Holding(),time) -> Initiates(Pour(thing),Filled(thing),time).\n"
    "[thing,time] Terminates(Spill(thing),Filled(thing),time).\n"
    "!HoldsAt(Filled(Cup),0).\n!HoldsAt(Holding(),0).\n"
    "Happens(Grasp(),0).\nHappens(Pour(Cup),1).\ncompletion Happens\n";  // lines 14 to 16

TEST_CASE("a chain of events, effects and inertia is told in the order of time") {
  const CliFixture cli;
  cli.write("m.e", kCup);
  const auto result = cli.parallax({"explain", "m.e", "--why", "HoldsAt( Filled(Cup), 4 )"});
  CHECK(result.code == 0);
  CHECK(result.err == "");
  CHECK(result.out ==
        "Filled(Cup) holds at 4 in trace 1:\n"
        "   0  Grasp() happens: stated\n"
        "          m.e:14  Happens(Grasp(),0)\n"
        "   1  Holding() holds: because Grasp() happens at 0\n"
        "          m.e:9  [time] Initiates(Grasp(),Holding(),time)\n"
        "   1  Pour(Cup) happens: stated\n"
        "          m.e:15  Happens(Pour(Cup),1)\n"
        "   2  Filled(Cup) holds: because Holding() holds at 1 and Pour(Cup) happens at 1\n"
        "          m.e:10  [thing,time] HoldsAt(Holding(),time) -> "
        "Initiates(Pour(thing),Filled(thing),time)\n"
        "   4  Filled(Cup) holds: as it has since 2: Spill(Cup) did not happen\n"
        "          m.e:4  inertia of Filled(thing)\n");
  const auto json = json_of(cli, {"explain", "m.e", "--why", "HoldsAt(Filled(Cup),4)"});
  CHECK(json["steps"].size() == 5);
  CHECK(json["steps"][4]["why"] == "inertia");
  CHECK(json["steps"][4]["since"] == 2);
  CHECK(json["steps"][3]["axiom"]["line"] == 10);
  CHECK(json["steps"][3]["premises"][1] == "Happens(Pour(Cup),1)");
  const auto without = cli.parallax({"explain", "m.e", "--why", "!Holding"});
  CHECK(without.code == 2);
}

TEST_CASE("what does not hold is explained, whichever way it is asked") {
  const CliFixture cli;
  cli.write("m.e", kCup);
  for (const auto* fact : {"HoldsAt(Holding,0)", "!HoldsAt(Holding(),0)"}) {
    const auto result = cli.parallax({"explain", "m.e", "--why", fact});
    CHECK(holds(result.out, "Holding() does not hold at 0 in trace 1:\n"));
    CHECK(holds(result.out, "does not hold: stated\n          m.e:13"));
  }
}

TEST_CASE("facts and traces that do not exist are refused with the nearest name") {
  const CliFixture cli;
  cli.write("m.e", kCup);
  const auto name = cli.parallax({"explain", "m.e", "--why", "HoldsAt(Filed(Cup),1)"});
  CHECK(name.code == 2);
  CHECK(holds(name.err, "E7305"));
  CHECK(holds(name.err, "but `Filled(Cup)`"));
  CHECK(cli.parallax({"explain", "m.e", "--why", "HoldsAt(Filled(Cup),9)"}).code == 2);
  CHECK(cli.parallax({"explain", "m.e", "--why", "HoldsAt(Filled(Cup),x)"}).code == 2);
  CHECK(cli.parallax({"explain", "m.e", "--why", "HoldsAt("}).code == 2);
  CHECK(cli.parallax({"explain", "m.e", "--why", "Happens(Grasp(),4)"}).code == 2);
  const auto trace =
      cli.parallax({"explain", "m.e", "--why", "Happens(Grasp(),0)", "--trace", "2"});
  CHECK(trace.code == 2);
  CHECK(holds(trace.err, "there is no trace 2: the model has 1"));
}

TEST_CASE("a run of a contradictory model says that the contradiction was checked") {
  const CliFixture cli;
  cli.write("start.e", cli.read("start.e") + "\nHoldsAt(Holding(),0).\n!HoldsAt(Holding(),0).\n");
  const auto result = cli.parallax({"run", "scenario.yaml", "--out", "r"});
  CHECK(result.code == 3);
  CHECK(holds(result.err, "E7001"));
  CHECK(holds(result.err, "a proof of the contradiction was checked"));
}

TEST_CASE("a discrepancy of a run is laid to the axioms that exclude what was seen") {
  const CliFixture cli;
  const auto run = cli.parallax({"run", "wrong_model.yaml", "--out", "r", "--max-runs", "20"});
  REQUIRE(run.code == 1);
  const auto result = cli.parallax({"explain", "r"});
  CHECK(result.code == 1);
  CHECK(holds(result.out, "observed: Holding() does not hold at 1\n"));
  CHECK(holds(result.out, "set 1: 1 axiom (proof checked)\n"));
  // It forgets that the box must be in the robot's region.
  CHECK(holds(result.out, "wrong_domain.e:32  [time] Initiates(PickUp(),Holding(),time)\n"));
  CHECK(cli.parallax({"explain", "r", "--sample", "9.9"}).code == 2);
  // Questions that a run folder cannot answer are refused, not passed over.
  CHECK(cli.parallax({"explain", "r", "--why", "HoldsAt(Holding(),1)"}).code == 2);
  CHECK(cli.parallax({"explain", "r", "--until", "x("}).code == 2);
  CHECK(cli.parallax({"explain", "."}).code == 2);
}

}  // namespace
}  // namespace parallax::test
