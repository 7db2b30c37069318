// Executions on record, as `monitor` and `run --resume` check them: the plan goes through them
// again.

#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/tools/cli_json.h"
#include "tests/tools/executed_plan.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

TEST_CASE("executions on record are checked by the monitor, outcomes too") {
  const TwoModels cli;
  json_of(cli, {"run", "two/sticks.yaml", "--execution", "closed-loop", "--out", "out"}, 1);
  const auto checked = json_of(cli, {"monitor", "two/sticks.yaml", "out"}, 1);
  std::vector<std::string> verdicts;
  for (const auto& run : checked.at("runs")) verdicts.push_back(run.at("verdict"));
  REQUIRE_FALSE(verdicts.empty());
  CHECK(verdicts.back() == "inconsistent");
  CHECK(std::count(verdicts.begin(), verdicts.end(), "inconsistent") == 1);
  json_of(cli, {"run", "two/agree.yaml", "--execution", "closed-loop", "--out", "good"});
  json_of(cli, {"monitor", "two/agree.yaml", "good"});
}

TEST_CASE("what a plan does after failures by their reasons is followed by the monitor") {
  const TwoModels cli;
  const std::string plan = R"((def-cram-function open-it ()
  (with-failure-handling
      ((navigation-low-level-failure (e)
         (perform (an action (type reaching)))
         (return)))
    (perform (an action (type opening) (object (an object (name top)))))))
(open-it)
)";
  const auto scenario = executed(cli, kSticks, plan, kSticks, "mapping: {Sticks(): ignored}\n");
  cli.replace("two/robot.bind", "else manipulation-goal-not-reached\naction closing",
              "else manipulation-goal-not-reached\n  on failed navigation-pose-unreachable\n"
              "action closing");
  const auto report = json_of(cli, {"run", scenario, "--out", "out"});
  CHECK(report.at("traces").at(0).at("paths").size() == 2);
  const auto checked = json_of(cli, {"monitor", scenario, "out"});
  CHECK(checked.at("runs").size() == report.at("simulations"));
  CHECK(cli.parallax({"replay", "out"}).code == 0);
  // As a log, too: the robot's plan handles the raised failure.
  cli.write("log.jsonl", R"j({"t": 1, "event": "OpenDrawer(top)", "outcome": "failed"}
{"t": 2, "event": "Reach()", "outcome": "ok"}
)j");
  json_of(cli, {"monitor", scenario, "log.jsonl"});
}

TEST_CASE("executions on record are what the plan does with what was seen and reported") {
  const TwoModels cli;
  const std::vector<std::string> run = {"run",         "two/agree.yaml", "--execution",
                                        "closed-loop", "--out",          "out"};
  json_of(cli, run);
  const auto journal = cli.read("out/journal.ndjson");
  const auto second = journal.find('\n') + 1;
  const std::pair<std::string, std::string> changes[] = {
      // The plan would have raised a condition, and not have gone on like that.
      {R"j("outcomes":[{"status":"ok")j", R"j("outcomes":[{"status":"failed")j"},
      {R"j("succeeded":true)j", R"j("succeeded":false)j"},
      {R"j("event":"CloseDrawer(top)")j", R"j("event":"Park()")j"},
      {R"j("object":"top")j", R"j("object":"bottom")j"},
      {R"j("end":"done")j", R"j("end":"failed")j"}};
  for (const auto& [from, to] : changes) {
    CAPTURE(from);
    auto changed = journal;
    const auto at = changed.find(from, second);
    REQUIRE(at != std::string::npos);
    changed.replace(at, from.size(), to);
    cli.write("out/journal.ndjson", changed);
    auto resume = run;
    resume.emplace_back("--resume");
    for (const auto& words : {resume, {"monitor", "two/agree.yaml", "out"}}) {
      const auto answer = cli.parallax(words);
      CHECK(answer.code == 3);
      CHECK(answer.err.find("out/journal.ndjson:2:") == 0);
      CHECK(answer.err.find("error[E7103]") != std::string::npos);
    }
  }
}

TEST_CASE("a run of which some was not checked is not consistent") {
  const TwoModels cli;
  const auto report =
      json_of(cli, {"run", "two/agree.yaml", "--execution", "closed-loop", "--out", "out"});
  for (const auto* limit : {"0.01", "0.02", "0.03", "0.05", "0.08", "20"}) {
    const auto answer =
        cli.parallax({"monitor", "two/agree.yaml", "out", "--json", "--time-limit", limit});
    CAPTURE(answer.out);
    const auto checked = Json::parse(answer.out);
    if (checked.at("status") == "error") continue;  // not even the model was read
    std::size_t consistent = 0;
    for (const auto& run : checked.at("runs")) {
      if (run.at("verdict") == "consistent") ++consistent;
    }
    CHECK((checked.at("verdict") == "consistent") == (consistent == report.at("simulations")));
    CHECK(answer.code == (checked.at("verdict") == "consistent" ? 0 : 4));
  }
}

}  // namespace
}  // namespace parallax::test
