// Mistakes in a model with an event that no plan performs: a kettle boils by itself.

#include <doctest/doctest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

/// Texts of the model and what stands in their place.
using Mistakes = std::vector<std::pair<std::string, std::string>>;

/// The kettle's world and, as the model, a copy in which texts are replaced.
struct Kettle : CliFixture {
  explicit Kettle(const Mistakes& mistakes) {
    write("truth.e",
          "fluent Filled()\nfluent On()\nfluent Hot()\nfluent Tea()\n"
          "event Fill()\nevent SwitchOn()\nevent Boil()\nevent Wait()\nevent Pour()\n\n"
          "[time] Initiates(Fill(),Filled(),time).\n"
          "[time] HoldsAt(Filled(),time) -> Initiates(SwitchOn(),On(),time).\n"
          "[time] HoldsAt(On(),time) -> Happens(Boil(),time).\n"
          "[time] Happens(Boil(),time) -> HoldsAt(On(),time).\n"
          "[time] Initiates(Boil(),Hot(),time).\n"
          "[time] Terminates(Boil(),On(),time).\n"
          "[time] HoldsAt(Hot(),time) -> Initiates(Pour(),Tea(),time).\n"
          "[time] Terminates(Pour(),Filled(),time).\n");
    write("model.e", read("truth.e"));
    for (const auto& [right, wrong] : mistakes) replace("model.e", right, wrong);
    write("start.e",
          "!HoldsAt(Filled(),0).\n!HoldsAt(On(),0).\n!HoldsAt(Hot(),0).\n!HoldsAt(Tea(),0).\n");
    write("plan.lisp",
          "(perform (an action (type filling)))\n(perform (an action (type switching)))\n"
          "(perform (an action (type waiting)))\n(perform (an action (type pouring)))\n");
    write("robot.bind",
          "action filling () -> Fill() ok: Filled() @t+1 else manipulation-goal-not-reached\n"
          "action switching () -> SwitchOn() ok: On() @t+1 else manipulation-goal-not-reached\n"
          "action waiting () -> Wait() ok: Hot() @t+1 else manipulation-goal-not-reached\n"
          "action pouring () -> Pour() ok: Tea() @t+1 else manipulation-goal-not-reached\n");
    write("own.yaml",
          "plan: plan.lisp\nbind: robot.bind\nhorizon: 4\nmodel: [model.e, start.e]\n"
          "simulator: {model: truth.e}\nexecution: closed-loop\nconstraints: \"time=4\"\n");
  }

  nlohmann::json repaired() const {
    json_of(*this, {"run", "own.yaml", "--out", "out"}, 1);
    return json_of(*this, {"repair", "out"}, 1);
  }

  /// The first proposal, applied, makes the next run clean.
  void check_first() const {
    const auto report = repaired();
    CAPTURE(report.dump(1));
    const auto& first = report.at("proposals").at(0);
    CHECK(first.at("runs_to_the_end") == first.at("runs"));
    CHECK(first.at("only_begins") == false);
    CHECK(parallax({"repair", "out", "--apply", "1"}).code == 0);
    CHECK(json_of(*this, {"run", "own.yaml", "--epsilon", "0.3", "--out", "again"}).at("verdict") ==
          "no-discrepancy");
  }
};

TEST_CASE("an effect of a demanded event is missing") {
  Kettle(Mistakes{{"[time] Terminates(Boil(),On(),time).\n", ""}}).check_first();
}

TEST_CASE("the trigger has a negated condition") {
  Kettle(Mistakes{{"HoldsAt(On(),time) -> Happens", "!HoldsAt(On(),time) -> Happens"}})
      .check_first();
}

TEST_CASE("an effect is written under another event") {
  Kettle(Mistakes{{"Initiates(Fill(),Filled(),time)", "Initiates(Pour(),Filled(),time)"}})
      .check_first();
}

TEST_CASE("two mistakes in one run: the first proposal mends both") {
  Kettle(Mistakes{{"[time] Terminates(Boil(),On(),time).\n", ""},
                  {"[time] Terminates(Pour(),Filled(),time).\n", ""}})
      .check_first();
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
