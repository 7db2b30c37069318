// `validate`: proposals are held against runs of other plans.

#include <filesystem>

#include "tests/tools/repair/mistaken_world.h"

namespace parallax::test {
namespace {

const std::string kLit = "[time] HoldsAt(On(),time) -> Initiates(Press(),Lit(),time).\n";

/// A lamp that a press lights if it is switched on; the plan shows no press without that.
struct Lamp : MistakenWorld {
  explicit Lamp(const std::string& wrong, const std::string& more = "")
      : MistakenWorld(
            "fluent On()\nfluent Lit()\nevent Switch()\nevent Press()\n"
            "[time] Initiates(Switch(),On(),time).\n" +
                kLit,
            "!HoldsAt(On(),0).\n!HoldsAt(Lit(),0).\n", {{"Switch()", "On()"}, {"Press()", "Lit()"}},
            {{kLit, wrong}}) {
    write("press.lisp",
          "(with-failure-handling ((plan-failure (e) (return)))\n"
          "  (perform (an action (type acting-b))))\n"
          "(perform (an action (type acting-a)))\n"
          "(perform (an action (type acting-b)))\n");
    write("press.yaml",
          "include: own.yaml\nplan: press.lisp\nhorizon: 3\nconstraints: \"time=3\"\n");
    write("own2.yaml", "include: own.yaml\nvalidate: [press.yaml]\n" + more);
  }
};

TEST_CASE("another plan bears out the right proposal, and refutes those that forget a condition") {
  const Lamp cli("");
  json_of(cli, {"run", "own2.yaml", "--out", "out"}, 1);
  const auto report = json_of(cli, {"repair", "out", "--limit", "0"}, 1);
  CAPTURE(report.dump(1));
  bool any_right = false, any_refuted = false;
  for (const auto& proposal : report.at("proposals")) {
    if (proposal.at("changes") != "model") continue;
    REQUIRE(proposal.at("other_plans").size() == 1);
    const auto& other = proposal.at("other_plans").at(0);
    CHECK(mentions(other.at("scenario"), "press.yaml"));
    CHECK(other.at("runs") == 1);
    const bool right = other.at("right") == 1;
    CHECK(other.at("refuted_by").get<std::string>().empty() == right);
    any_right = any_right || right;
    any_refuted = any_refuted || !right;
    // A press before the switch lights nothing.
    const std::string patch = proposal.at("patch");
    const bool is_whole = mentions(patch, "HoldsAt(On(),time) -> Initiates(Press(),Lit(),time)");
    const bool forgets = mentions(patch, "+[time] Initiates(Press(),Lit(),time)");
    if (is_whole) CHECK(right);
    if (forgets) CHECK_FALSE(right);
  }
  CHECK(any_right);
  const auto text = cli.parallax({"repair", "out", "--limit", "0"}).out;
  CAPTURE(text);
  CHECK(mentions(text, "Also right on 1 run of `"));
  if (any_refuted) CHECK(mentions(text, "Right on 0 of 1 run of `"));
}

TEST_CASE("without simulations no other plan is run") {
  const Lamp cli("");
  json_of(cli, {"run", "own2.yaml", "--out", "out"}, 1);
  for (const auto& proposal : json_of(cli, {"repair", "out", "--runs", "0"}, 1).at("proposals")) {
    CHECK_FALSE(proposal.contains("other_plans"));
  }
}

TEST_CASE("rounds copy the other scenarios, and end refuted where one of them refutes") {
  const Lamp right("");
  json_of(right, {"run", "own2.yaml", "--out", "out"}, 1);
  const auto clean = json_of(right, {"repair", "out", "--loop", "--out", "fixed"}, 0);
  CAPTURE(clean.dump(1));
  CHECK(clean.at("end") == "clean");
  CHECK(std::filesystem::exists(right.folder() / "fixed/files/press.lisp"));
}

TEST_CASE("a scenario that is not there is an error at its place") {
  const Lamp cli("");
  cli.write("own2.yaml", "include: own.yaml\nvalidate: [nowhere.yaml]\n");
  const auto ended = cli.parallax({"run", "own2.yaml", "--out", "out"});
  CHECK(ended.code == 3);
  CHECK(mentions(ended.err, "own2.yaml:2:12"));
  CHECK(mentions(ended.err, "nowhere.yaml"));
}

}  // namespace
}  // namespace parallax::test
