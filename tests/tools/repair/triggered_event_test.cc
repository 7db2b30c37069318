// Mistakes in a model with an event that no plan performs: a kettle boils by itself.

#include "tests/tools/repair/mistaken_world.h"

namespace parallax::test {
namespace {

using Mistakes = MistakenWorld::Mistakes;

/// The kettle's world and, as the model, a copy in which texts are replaced.
struct Kettle : MistakenWorld {
  explicit Kettle(const Mistakes& mistakes)
      : MistakenWorld(
            "fluent Filled()\nfluent On()\nfluent Hot()\nfluent Tea()\n"
            "event Fill()\nevent SwitchOn()\nevent Boil()\nevent Wait()\nevent Pour()\n\n"
            "[time] Initiates(Fill(),Filled(),time).\n"
            "[time] HoldsAt(Filled(),time) -> Initiates(SwitchOn(),On(),time).\n"
            "[time] HoldsAt(On(),time) -> Happens(Boil(),time).\n"
            "[time] Happens(Boil(),time) -> HoldsAt(On(),time).\n"
            "[time] Initiates(Boil(),Hot(),time).\n"
            "[time] Terminates(Boil(),On(),time).\n"
            "[time] HoldsAt(Hot(),time) -> Initiates(Pour(),Tea(),time).\n"
            "[time] Terminates(Pour(),Filled(),time).\n",
            "!HoldsAt(Filled(),0).\n!HoldsAt(On(),0).\n!HoldsAt(Hot(),0).\n!HoldsAt(Tea(),0).\n",
            {{"Fill()", "Filled()"},
             {"SwitchOn()", "On()"},
             {"Wait()", "Hot()"},
             {"Pour()", "Tea()"}},
            mistakes) {}
};

TEST_CASE("a trigger is missing: the event happens where its precondition holds") {
  const Kettle cli(Mistakes{{"[time] HoldsAt(On(),time) -> Happens(Boil(),time).\n", ""}});
  CHECK(cli.first() == "a trigger is missing: `HoldsAt(On(),time) -> Happens(Boil(),time)`");
}

TEST_CASE("a trigger is missing, and nothing says when the event may happen") {
  const std::string unseen = "[time] Happens(Boil(),time) -> HoldsAt(On(),time).\n";
  const Kettle cli(
      Mistakes{{"[time] HoldsAt(On(),time) -> Happens(Boil(),time).\n", ""}, {unseen, ""}});
  CHECK(mentions(cli.first(unseen),
                 "a trigger is missing: `HoldsAt(On(),time) -> Happens(Boil(),time)`"));
}

TEST_CASE("open loop: what the model demands is predicted, and what the plan performs is done") {
  const Kettle right(Mistakes{});
  CHECK(json_of(right, {"run", "open.yaml", "--epsilon", "0.3", "--out", "out"}).at("verdict") ==
        "no-discrepancy");
  CHECK(right.parallax({"replay", "out", "--sample", "1.1"}).code == 0);
  const Kettle wrong(Mistakes{
      {"[time] Initiates(Boil(),Hot(),time).\n", "[time] Initiates(Boil(),Tea(),time).\n"}});
  // The plan's goal needs what the model does not say: its traces are followed all the same.
  wrong.replace("robot.bind", "ok: Hot()", "ok: Filled()");
  wrong.replace("robot.bind", "ok: Tea()", "ok: !Filled()");
  json_of(wrong, {"run", "open.yaml", "--out", "out"}, 1);
  const auto report = json_of(wrong, {"repair", "out"}, 1);
  CAPTURE(report.dump(1));
  CHECK(mentions(report.at("proposals").at(0).at("words"), "Initiates(Boil(),Hot(),time)"));
}

TEST_CASE("an effect comes at once, not a step later") {
  const Kettle cli(Mistakes{{"[time] Initiates(Fill(),Filled(),time).\n",
                             "[event,time] Happens(Fill(),time-1) & Happens(event,time) -> "
                             "Initiates(event,Filled(),time).\n"}});
  CHECK(mentions(cli.first(), "Initiates(Fill(),Filled(),time)"));
}

TEST_CASE("random sequences of events bear a proposal out, or refute it") {
  // The plan fills the kettle before it switches it on, so that only they tell.
  const Kettle cli(
      Mistakes{{"[time] HoldsAt(Filled(),time) -> Initiates(SwitchOn(),On(),time).\n", ""}});
  const auto report = cli.repaired();
  CAPTURE(report.dump(1));
  CHECK(report.at("sequences").get<int>() > 0);
  const auto& first = report.at("proposals").at(0);
  CHECK(first.at("sequences_right") == report.at("sequences"));
  CHECK(mentions(first.at("words"), "HoldsAt(Filled(),time) -> Initiates(SwitchOn(),On(),time)"));
  CHECK(mentions(cli.parallax({"repair", "out"}).out, "Also right on "));
  CHECK(json_of(cli, {"repair", "out", "--runs", "0"}, 1).at("sequences") == 0);
}

TEST_CASE("an effect of a demanded event is missing") {
  Kettle(Mistakes{{"[time] Terminates(Boil(),On(),time).\n", ""}}).first();
}

TEST_CASE("the trigger has a negated condition") {
  Kettle(Mistakes{{"HoldsAt(On(),time) -> Happens", "!HoldsAt(On(),time) -> Happens"}}).first();
}

TEST_CASE("the trigger demands another event") {
  const Kettle cli(Mistakes{{"-> Happens(Boil(),time)", "-> Happens(Pour(),time)"}});
  CHECK(mentions(cli.first(), "`Happens(Pour(),time)` becomes `Happens(Boil(),time)`"));
}

TEST_CASE("an effect is written under another event") {
  Kettle(Mistakes{{"Initiates(Fill(),Filled(),time)", "Initiates(Pour(),Filled(),time)"}}).first();
}

TEST_CASE("two mistakes in one run: the first proposal mends both") {
  Kettle(Mistakes{{"[time] Terminates(Boil(),On(),time).\n", ""},
                  {"[time] Terminates(Pour(),Filled(),time).\n", ""}})
      .first();
}

TEST_CASE("a superfluous effect is dropped before its sign is changed") {
  const Kettle cli(Mistakes{{"[time] Initiates(Fill(),Filled(),time).\n",
                             "[time] Initiates(Fill(),Filled(),time).\n"
                             "[time] Initiates(Fill(),Tea(),time).\n"}});
  const auto report = cli.repaired();
  CAPTURE(report.dump(1));
  const std::string words = report.at("proposals").at(0).at("words");
  CHECK(words.find("`Initiates(Fill(),Tea(),time)`") != std::string::npos);
  CHECK(words.find("is dropped") != std::string::npos);
}

TEST_CASE("what no run follows to its end says so and stands behind what some run follows") {
  const Kettle cli(
      Mistakes{{"Initiates(Fill(),Filled(),time)", "Initiates(Pour(),Filled(),time)"}});
  const auto report = cli.repaired();
  bool behind = false;
  for (const auto& proposal : report.at("proposals")) {
    const bool only_begins = proposal.at("runs_to_the_end") == 0;
    CHECK(proposal.at("only_begins") == only_begins);
    CHECK((only_begins || !behind));
    behind = behind || only_begins;
  }
  REQUIRE(behind);
  CHECK(cli.parallax({"repair", "out"}).out.find("no run follows the changed model to its end") !=
        std::string::npos);
}

}  // namespace
}  // namespace parallax::test
