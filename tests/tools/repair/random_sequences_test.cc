// Random sequences of events: which are drawn, and what they decide.

#include <algorithm>

#include "tests/tools/repair/mistaken_world.h"

namespace parallax::test {
namespace {

using Mistakes = MistakenWorld::Mistakes;

const std::string kBoils = "[time] HoldsAt(On(),time) -> Happens(Boil(),time).\n";
const std::string kStops = "[time] Terminates(Boil(),On(),time).\n";

/// A kettle that boils by itself; the plan never cools it.
struct Kettle : MistakenWorld {
  explicit Kettle(const Mistakes& mistakes, const std::string& boils = kBoils,
                  const std::string& more = "")
      : MistakenWorld(
            "fluent Filled()\nfluent On()\nfluent Hot()\nfluent Tea()\n"
            "event Fill()\nevent SwitchOn()\nevent Boil()\nevent Wait()\nevent Pour()\n" +
                more +
                "[time] Initiates(Fill(),Filled(),time).\n"
                "[time] HoldsAt(Filled(),time) -> Initiates(SwitchOn(),On(),time).\n" +
                boils + "[time] Initiates(Boil(),Hot(),time).\n" + kStops +
                "[time] HoldsAt(Hot(),time) -> Initiates(Pour(),Tea(),time).\n"
                "[time] Terminates(Pour(),Filled(),time).\n",
            "!HoldsAt(Filled(),0).\n!HoldsAt(On(),0).\n!HoldsAt(Hot(),0).\n!HoldsAt(Tea(),0).\n",
            {{"Fill()", "Filled()"},
             {"SwitchOn()", "On()"},
             {"Wait()", "Hot()"},
             {"Pour()", "Tea()"}},
            mistakes) {}
};

TEST_CASE("two events of one trigger: the true model is not refuted") {
  const Kettle cli(Mistakes{{kStops, ""}},
                   "[time] HoldsAt(On(),time) -> Happens(Boil(),time) & Happens(Whistle(),time).\n"
                   "[time] HoldsAt(Tea(),time) & HoldsAt(Filled(),time) -> "
                   "Happens(Boil(),time).\n",
                   "event Whistle()\n");
  const auto report = cli.repaired();
  CAPTURE(report.dump(1));
  const auto& first = report.at("proposals").at(0);
  CHECK(first.at("words") == "an effect is missing: `Terminates(Boil(),On(),time)`");
  CHECK(first.at("sequences_right") == report.at("sequences"));
  CHECK(first.at("refuted_by") == "");
}

TEST_CASE("an event that the plan does not perform refutes, too") {
  const Kettle cli(Mistakes{{"[time] Initiates(Fill(),Filled(),time).\n", ""},
                            {"[time] Terminates(Cool(),Hot(),time).\n", ""}},
                   kBoils, "event Cool()\n[time] Terminates(Cool(),Hot(),time).\n");
  const auto report = cli.repaired();
  CAPTURE(report.dump(1));
  CHECK(report.at("sequences_of_plan") == false);
  const auto& first = report.at("proposals").at(0);
  CHECK(first.at("sequences_right") < report.at("sequences"));
  CHECK(mentions(first.at("refuted_by"), "Cool()"));
}

TEST_CASE("rounds that end with a clean run and a refuted model do not end clean") {
  for (const std::string time : {"time", "time1"}) {
    CAPTURE(time);
    const auto boils = [&](const std::string& fluent) {
      return "[" + time + "] HoldsAt(" + fluent + "," + time + ") -> Happens(Boil()," + time +
             ").\n";
    };
    const Kettle cli(Mistakes{{boils("On()"), boils("Tea()")}, {kStops, ""}}, boils("On()"));
    json_of(cli, {"run", "own.yaml", "--epsilon", "0.3", "--out", "out"}, 1);
    const auto before = cli.read("model.e");
    const auto report =
        json_of(cli, {"repair", "out", "--loop", "--out", "fixed", "--apply", "1"}, 1);
    CAPTURE(report.dump(1));
    CHECK(report.at("end") == "refuted");
    CHECK(mentions(report.at("why"), "refuted by a random sequence of events: "));
    CHECK(mentions(cli.read("fixed/rounds.txt"), "refuted: the run after it is clean"));
    CHECK(cli.read("model.e") == before);
  }
}

/// A drawer that opens only as `condition` says; the model has no such effect.
struct Drawer : MistakenWorld {
  static std::string opens(const std::string& condition) {
    return "[time] " + condition + " -> Initiates(Pull(),Open(),time).\n";
  }
  static std::string world(const std::string& condition) {
    std::string out = "fluent Open()\nevent Pull()\nevent Shut()\n";
    for (const std::string i : {"0", "1", "2", "3", "4", "5"}) {
      out += "fluent F" + i + "()\nevent E" + i + "()\nevent G" + i + "()\n[time] Initiates(E" + i +
             "(),F" + i + "(),time).\n[time] Terminates(G" + i + "(),F" + i + "(),time).\n";
    }
    return out + opens(condition) + "[time] Terminates(Shut(),Open(),time).\n";
  }
  explicit Drawer(const std::string& condition)
      : MistakenWorld(world(condition),
                      "!HoldsAt(F0(),0).\n!HoldsAt(F1(),0).\n!HoldsAt(F2(),0).\n"
                      "!HoldsAt(F3(),0).\n!HoldsAt(F4(),0).\n!HoldsAt(F5(),0).\n"
                      "!HoldsAt(Open(),0).\n",
                      {{"E0()", "F0()"},
                       {"E1()", "F1()"},
                       {"Pull()", "Open()"},
                       {"G1()", "!F1()"},
                       {"Shut()", "!Open()"},
                       {"E2()", "F2()"},
                       {"E3()", "F3()"},
                       {"E5()", "F5()"},
                       {"G0()", "!F0()"}},
                      {{opens(condition), ""}}) {}
};

TEST_CASE(
    "conditions that are right on all sequences that chose them are tied, and fresh ones tell") {
  const Drawer cli("HoldsAt(F0(),time) & HoldsAt(F1(),time) & !HoldsAt(F5(),time)");
  json_of(cli, {"run", "own.yaml", "--seed", "2", "--out", "out"}, 1);
  const auto report = json_of(cli, {"repair", "out"}, 1);
  CAPTURE(report.dump(1));
  CHECK(report.at("sequences_choosing") == 40);
  CHECK(report.at("tied") == 2);
  int fresh_refute = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& proposal = report.at("proposals").at(i);
    CHECK(proposal.at("choosing_right") == 40);
    if (proposal.at("sequences_right") < report.at("sequences")) ++fresh_refute;
  }
  CHECK(fresh_refute == 1);
  CHECK(mentions(cli.parallax({"repair", "out"}).out, "fresh random sequences of events; refuted"));
}

}  // namespace
}  // namespace parallax::test
