// `parallax coverage` of executed plans: items compared with the run's own account of its paths.
// Behaviours that the world never showed, or that the model lacks, are compared with answers known
// beforehand.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "tests/tools/cli_json.h"
#include "tests/tools/coverage_shares.h"
#include "tests/tools/executed_plan.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

/// Simulations by "line id".
std::map<std::string, int> hits_of(const Json& group) {
  std::map<std::string, int> out;
  for (const auto& item : group) {
    CHECK_FALSE(item.contains("traces"));
    out[std::to_string(item.at("line").get<int>()) + " " + item.at("id").get<std::string>()] =
        item.at("hits").get<int>();
  }
  return out;
}

/// Number of runs in the report that took a path that `fits`.
template <typename Fits>
int runs_with(const Json& report, const Fits& fits) {
  int out = 0;
  for (const auto& path : report.at("traces").at(0).at("paths")) {
    const auto events = path.at("events").get<std::vector<std::string>>();
    const auto outcomes = path.at("outcomes").get<std::vector<std::string>>();
    if (fits(events, outcomes)) out += path.at("simulations").get<int>();
  }
  return out;
}

using Words = std::vector<std::string>;
bool has(const Words& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

TEST_CASE("coverage of executions: each item as often as the paths of the report say") {
  const ExecutedRuns cli;
  const auto scenario = cli.scenario(kSticksAtTimes, kPlan, kSticksAtTimes);
  const auto report = json_of(cli, {"run", scenario, "--out", "out"});
  const auto coverage = json_of(cli, {"coverage", "out", "--lcov", "out.info"});
  const int all = report.at("simulations");
  REQUIRE(all >= 90);
  CHECK(coverage.at("simulations") == all);
  CHECK(coverage.at("executions") == all);
  CHECK(report.at("coverage") == shares_of(coverage));
  const auto failures = [](const Words& outcomes) {
    return std::count_if(outcomes.begin(), outcomes.end(),
                         [](const auto& outcome) { return outcome != "ok"; });
  };
  const auto with = [&](const std::string& event) {
    return runs_with(report, [&](const auto& events, const auto&) { return has(events, event); });
  };
  const int parks = with("Park()"), closes = with("CloseDrawer(top)");
  const int fails =
      runs_with(report, [&](const auto&, const auto& outcomes) { return failures(outcomes) > 0; });
  const int opens =
      runs_with(report, [&](const auto&, const auto& outcomes) { return failures(outcomes) < 2; });
  // All are likely: a half of the starts, and of the open outcomes.
  REQUIRE(std::min({parks, all - parks, closes, fails, all - opens}) > 0);
  CHECK(hits_of(coverage.at("performs")) == std::map<std::string, int>{{"2 Park", parks},
                                                                       {"6 OpenDrawer", all},
                                                                       {"8 CloseDrawer", closes}});
  CHECK(hits_of(coverage.at("branches")) ==
        std::map<std::string, int>{{"2 Park fails", 0},
                                   {"2 Park succeeds", parks},
                                   {"2 Parked(): false", parks},
                                   {"2 Parked(): true", all - parks},
                                   {"6 OpenDrawer fails", fails},
                                   {"6 OpenDrawer succeeds", opens},
                                   {"7 Open(top): false", all - opens},
                                   {"7 Open(top): true", opens},
                                   {"8 CloseDrawer fails", 0},
                                   {"8 CloseDrawer succeeds", closes}});
  CHECK(hits_of(coverage.at("handlers")) ==
        std::map<std::string, int>{{"5 manipulation-low-level-failure", fails}});
  CHECK(hits_of(coverage.at("retries")) ==
        std::map<std::string, int>{{"6 OpenDrawer again", fails}});
  const auto events = hits_of(coverage.at("events"));
  CHECK(events.at("9 OpenDrawer") == all);
  CHECK(events.at("11 Park") == parks);
  CHECK(events.at("12 Reach") == 0);
  // The axiom by which the drawer opens in the model is covered where it opened in the world.
  CHECK(hits_of(coverage.at("axioms")).at("3 initiates") == opens);
  CHECK(coverage.at("traces").empty());
  CHECK(coverage.at("never_shown").empty());
  CHECK(coverage.at("not_in_model").empty());
  CHECK(cli.read("out.info").find("BRDA:6,") != std::string::npos);

  // A path that the plan does not take is no record of this run.
  auto journal = cli.read("out/journal.ndjson");
  const std::string opening = "\"event\":\"OpenDrawer(top)\"";
  journal.replace(journal.find(opening), opening.size(), "\"event\":\"CloseDrawer(top)\"");
  cli.write("out/journal.ndjson", journal);
  const auto foreign = cli.parallax({"coverage", "out"});
  CHECK(foreign.code == 3);
  CHECK(foreign.err.find("error[E7103]") != std::string::npos);
}

TEST_CASE("what the model has possible and no execution showed, with its bound") {
  const ExecutedRuns cli;
  const auto scenario = cli.scenario(kSticksAtTimes, kPlan, "load opens.e\n");
  const auto report = json_of(cli, {"run", scenario, "--out", "out"});
  const int all = report.at("simulations");
  const auto coverage = json_of(cli, {"coverage", "out"});
  REQUIRE(coverage.at("never_shown").size() == 1);
  const auto& never = coverage.at("never_shown").at(0);
  CHECK(never.at("file") == "two/plan.lisp");
  CHECK(never.at("line") == 6);
  CHECK(never.at("event") == "OpenDrawer(top)");
  CHECK(never.at("outcome") == "fails");
  CHECK(never.at("possible") == all);
  CHECK(never.at("executions") == all);
  CHECK(never.at("confidence") == 0.99);
  // With a greater probability a row like this had come with less than 1 %.
  const double bound = never.at("bound");
  CHECK(std::pow(1.0 - bound, all) == doctest::Approx(0.01));
  const auto text = cli.parallax({"coverage", "out"}).out;
  CHECK(text.find("model behaviours that the world never showed\n"
                  "    two/plan.lisp:6  OpenDrawer(top) fails: possible in " +
                  std::to_string(all)) != std::string::npos);
  // Another run of the scenario adds to it, the same one does not.
  json_of(cli, {"run", scenario, "--out", "more", "--seed", "2"});
  std::filesystem::copy(cli.folder() / "out", cli.folder() / "copy");
  const auto both = json_of(cli, {"coverage", "out", "more", "copy"});
  const auto& twice = both.at("never_shown").at(0);
  CHECK(twice.at("possible") == both.at("simulations"));
  CHECK(twice.at("possible") > all);
  CHECK(twice.at("bound") < bound);
}

TEST_CASE("an outcome counts as possible only where the model has it after what was observed") {
  const ExecutedRuns cli;
  // It is stuck for ever or not at all: behind a failure no success is possible. The world is
  // stuck.
  const auto scenario = cli.scenario(kSticks, kPlan, "load domain.e\n");
  const auto report = json_of(cli, {"run", scenario, "--out", "out"});
  const auto coverage = json_of(cli, {"coverage", "out"});
  // Only at the first attempt; the drawer is never closed.
  REQUIRE(coverage.at("never_shown").size() == 1);
  CHECK(coverage.at("never_shown").at(0).at("event") == "OpenDrawer(top)");
  CHECK(coverage.at("never_shown").at(0).at("outcome") == "succeeds");
  CHECK(coverage.at("never_shown").at(0).at("possible") == report.at("simulations"));
}

TEST_CASE("what the world does and the model lacks: event, outcome and fluent") {
  const ExecutedRuns cli;
  const auto scenario = cli.scenario(kSticks, kPlan, kSticksAtTimes);
  json_of(cli, {"run", scenario, "--out", "out"}, 1);
  const auto coverage = json_of(cli, {"coverage", "out"});
  REQUIRE(coverage.at("not_in_model").size() == 1);
  const auto& lacking = coverage.at("not_in_model").at(0);
  CHECK(lacking.at("event") == "OpenDrawer(top)");
  CHECK(lacking.at("outcome") == "succeeds");
  CHECK(lacking.at("source") == "two/plan.lisp:6");
  CHECK(lacking.at("lacks") == "outcome");
  CHECK(lacking.at("observed") == Json({"Open(top)"}));
  CHECK(lacking.at("executions") == 1);
  const auto text = cli.parallax({"coverage", "out"}).out;
  CHECK(text.find("world behaviours that the model lacks\n"
                  "    two/plan.lisp:6  OpenDrawer(top) succeeds: it cannot end so there; "
                  "observed: Open(top) (1 execution, the first 1.") != std::string::npos);
}

TEST_CASE("a handler counts where the condition that was raised is its own") {
  const ExecutedRuns cli;
  const std::string plan = R"((def-cram-function park-it ()
  (with-failure-handling
      ((navigation-low-level-failure (e) (return))
       (manipulation-low-level-failure (e) (return)))
    (perform (an action (type parking-arms)))))
(park-it)
)";
  const std::string bound = "else manipulation-goal-not-reached\naction reaching";
  cli.replace("two/robot.bind", bound,
              "else manipulation-goal-not-reached\n  on not-possible navigation-pose-unreachable\n"
              "action reaching");
  // The world forbids parking when parked; so must the model, or else that is a difference.
  const std::string forbids =
      "load opens.e\n[time] Happens(Park(),time) -> !HoldsAt(Parked(),time).\n";
  cli.write("two/start.e", "[drawer] !HoldsAt(Open(drawer),0).\nHoldsAt(Parked(),0).\n");
  const auto scenario = cli.scenario("load opens.e\nfluent Sticks()\n", plan, forbids);
  const auto report = json_of(cli, {"run", scenario, "--out", "out"}, 1);
  const auto coverage = json_of(cli, {"coverage", "out"});
  CHECK(hits_of(coverage.at("handlers")) ==
        std::map<std::string, int>{{"3 navigation-low-level-failure", 1},
                                   {"4 manipulation-low-level-failure", 0}});
}

}  // namespace
}  // namespace parallax::test
