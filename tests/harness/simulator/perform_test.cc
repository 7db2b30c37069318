// A run as one request, against the same run one request at a time, with a simulator in Python.

#include <doctest/doctest.h>

#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include "harness/simulator/process_simulator.h"

namespace parallax::harness {
namespace {

bool no_python() {
  if (std::system("command -v python3 > /dev/null") == 0) return false;
  std::cout << "SKIPPED: there is no python3\n";
  return true;
}

ProcessSimulator room() {
  ProcessOptions options;
  options.command = {
      "python3", "-B",
      std::string(PARALLAX_SOURCE_DIR) + "/tools/adapters/python/examples/kinematic_2d.py"};
  return ProcessSimulator(options);
}

const State kStart = {{"robot.x", 0.7}, {"robot.y", 0.1}, {"crate.x", 1.0}, {"crate.y", 0.1}};
const std::vector<AnnouncedAct> kActs = {
    {"pick-up", {}, 30.0},
    {"drive", {{"target.x", 0.4}, {"target.y", 0.2}}, 30.0},
    {"drive", {{"target.x", 3.0}, {"target.y", 1.4}}, 30.0},  // into the wall
    {"drive", {{"target.x", 0.2}, {"target.y", 0.0}}, 1.0},   // no time for all of it
    {"put-down", {}, 30.0}};

struct SeenRun {
  std::vector<Outcome> outcomes;
  std::vector<State> states;
};

SeenRun run_of(ProcessSimulator& simulator, bool is_announced, const State& start = kStart) {
  if (is_announced) simulator.announce([] { return kActs; });
  SeenRun run;
  run.outcomes.push_back(simulator.reset(start, 7));
  if (run.outcomes.back().status != SimStatus::kOk) return run;
  run.states.push_back(simulator.observe());
  for (const AnnouncedAct& act : kActs) {
    run.outcomes.push_back(simulator.act(act.action, act.arguments, act.sim_time_limit_s));
    run.states.push_back(simulator.observe());
  }
  return run;
}

void check_same(const SeenRun& a, const SeenRun& b) {
  REQUIRE(a.outcomes.size() == b.outcomes.size());
  CHECK(a.states == b.states);
  for (std::size_t i = 0; i < a.outcomes.size(); ++i) {
    CHECK(a.outcomes[i].status == b.outcomes[i].status);
    CHECK(a.outcomes[i].reason == b.outcomes[i].reason);
    CHECK(a.outcomes[i].sim_time_s == b.outcomes[i].sim_time_s);
    CHECK(a.outcomes[i].margins == b.outcomes[i].margins);
    CHECK(a.outcomes[i].motion == b.outcomes[i].motion);
  }
}

TEST_CASE("a run that was announced is what it is without that, motion included") {
  if (no_python()) return;
  auto simulator = room();
  REQUIRE(simulator.info().can("perform"));
  for (const double interval_s : {0.0, 0.1}) {
    simulator.record_motion(interval_s);
    const auto alone = run_of(simulator, false), at_once = run_of(simulator, true);
    REQUIRE(alone.outcomes.size() == 1 + kActs.size());
    CHECK(alone.outcomes[3].status == SimStatus::kFailed);
    CHECK(alone.outcomes[4].status == SimStatus::kTruncated);
    CHECK((interval_s > 0.0) != alone.outcomes[2].motion.frames.empty());
    check_same(alone, at_once);
    check_same(alone, run_of(simulator, false));  // nothing of it is left
  }
}

TEST_CASE("a start that cannot be ends a run that was announced, and the next one is fine") {
  if (no_python()) return;
  auto simulator = room();
  REQUIRE(simulator.info().can("perform"));
  auto in_wall = kStart;
  in_wall["robot.x"] = 2.0;
  const auto refused = run_of(simulator, true, in_wall);
  REQUIRE(refused.outcomes.size() == 1);
  CHECK(refused.outcomes[0].status == SimStatus::kInvalidStart);
  check_same(run_of(simulator, true), run_of(simulator, false));
}

TEST_CASE("what was announced holds for one reset, and for what was announced alone") {
  if (no_python()) return;
  auto simulator = room();
  REQUIRE(simulator.info().can("perform"));
  simulator.announce([] { return kActs; });
  REQUIRE(simulator.reset(kStart, 7).status == SimStatus::kOk);
  // Another reset before anything was done: the rest of the first run is of no account.
  REQUIRE(simulator.reset(kStart, 8).status == SimStatus::kOk);
  CHECK(simulator.act("put-down", {}, 30.0).status == SimStatus::kFailed);
  simulator.announce([] { return kActs; });
  REQUIRE(simulator.reset(kStart, 7).status == SimStatus::kOk);
  CHECK(simulator.observe().contains("robot.x"));
  const auto other = simulator.act("put-down", {}, 30.0);
  CHECK(other.status == SimStatus::kLost);
  CHECK(other.reason.find("something else was announced") != std::string::npos);
  CHECK(simulator.observe().contains(kLostVariable));
  CHECK(simulator.reset(kStart, 7).status == SimStatus::kOk);
}

}  // namespace
}  // namespace parallax::harness
