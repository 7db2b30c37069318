// Readable answers of a simulator that make no sense. Runs and `adapter-check` use these checks.

#include "harness/simulator/protocol_check.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <functional>
#include <iostream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "harness/simulator/process_simulator.h"

namespace parallax::harness {
namespace {

SimulatorInfo fine() {
  SimulatorInfo info;
  info.name = "plain";
  info.determinism = "bitwise";
  info.timestep_s = 0.01;
  info.parameters = {{"box.x", "m", true, -1.0, 1.0}, {"box.yaw", "rad", false}};
  info.actions = {"push"};
  info.arguments["push"] = {{"by", "m", true}};
  info.capabilities = {"describe", "margins", "noise", "perform", "poses"};
  return info;
}

TEST_CASE("what makes no sense in what a simulator says of itself is a fault") {
  CHECK(info_faults(fine()).empty());
  CHECK(info_oddities(fine()).empty());
  using Change = std::function<void(SimulatorInfo&)>;
  const std::pair<Change, const char*> changes[] = {
      {[](auto& info) { info.name.clear(); }, "it has no name"},
      {[](auto& info) { info.determinism = "total"; }, "`determinism` is `total`"},
      {[](auto& info) { info.timestep_s = -0.01; }, "`time_step` is -0.01 s"},
      {[](auto& info) { info.timestep_s = std::numeric_limits<double>::quiet_NaN(); },
       "`time_step` is nan s"},
      {[](auto& info) {
         info.parameters.push_back({"box.x", "mm"});
       },
       "`box.x` is declared twice"},
      {[](auto& info) {
         info.parameters.push_back({"", "m"});
       },
       "a variable has no name"},
      {[](auto& info) {
         info.parameters.push_back({"lost", "1"});
       },
       "a variable may not be called `lost`"},
      {[](auto& info) { info.parameters[0].lower = 2.0; }, "the bounds of `box.x` are reversed"},
      {[](auto& info) { info.actions.emplace_back("push"); }, "`push` is declared twice"},
      {[](auto& info) { info.actions.emplace_back(); }, "an action has no name"},
      {[](auto& info) {
         info.arguments["push"].push_back({"by", "rad"});
       },
       "of `push`: `by` is declared twice"},
      {[](auto& info) {
         info.arguments["push"].push_back({"", "m"});
       },
       "of `push`: an argument has no name"}};
  for (const auto& [change, words] : changes) {
    auto info = fine();
    change(info);
    const auto faults = info_faults(info);
    CAPTURE(words);
    REQUIRE(faults.size() == 1);
    CHECK(faults.front().find(words) != std::string::npos);
  }
  auto odd = fine();
  odd.capabilities = {"telepathy", "noise", "telepathy"};
  CHECK(info_faults(odd).empty());
  REQUIRE(info_oddities(odd).size() == 1);
  CHECK(info_oddities(odd).front() == "`telepathy` is no capability that is known here");
}

TEST_CASE("an act takes no longer than its limit, but for a little") {
  const auto fault_of = [](double took_s, double limit_s) {
    return outcome_fault("push", {SimStatus::kOk, "", took_s, {}}, limit_s, fine());
  };
  for (const double took_s : {0.0, 9.9, 10.0, 10.02, 10.5}) CHECK(fault_of(took_s, 10.0) == "");
  CHECK(fault_of(0.02, 0.0) == "");  // two steps
  CHECK(fault_of(11.0, 10.0) == "`push` ran 11 s with a limit of 10 s");
  CHECK(fault_of(1e9, 10.0) != "");
  CHECK(fault_of(-1.0, 10.0) != "");
  CHECK(fault_of(std::numeric_limits<double>::quiet_NaN(), 10.0) != "");
  CHECK(fault_of(std::numeric_limits<double>::infinity(), 10.0) != "");
}

/// A simulator in Python whose answers are these, by method.
ProcessSimulator answering(const std::string& hello, const std::string& act) {
  const std::string program =
      "import json, sys\n"
      "for line in sys.stdin:\n"
      "    ask = json.loads(line)\n"
      "    said = {'hello': " +
      hello + ", 'act': " + act +
      ",\n            'observe': {'state': {}}}.get(ask['method'], {'status': 'ok'})\n"
      "    print(json.dumps({'id': ask['id'], 'result': said}), flush=True)\n"
      "    if ask['method'] == 'close': break\n";
  ProcessOptions options;
  options.command = {"python3", "-c", program};
  return ProcessSimulator(options);
}

TEST_CASE("a simulator process that makes no sense does not begin, or is lost") {
  if (std::system("command -v python3 > /dev/null") != 0) {
    std::cout << "SKIPPED: there is no python3\n";
    return;
  }
  const std::string hello =
      "{'protocol': 1, 'name': 'plain', 'params': [{'name': 'x'}], 'actions': ['push']}";
  {
    auto plain = answering(hello, "{'status': 'ok', 'sim_time': 1}");
    CHECK(plain.info().name == "plain");
    CHECK(plain.reset({}, 1).status == SimStatus::kOk);
    CHECK(plain.act("push", {}, 2.0).status == SimStatus::kOk);
  }
  {
    auto twice = answering(
        "{'protocol': 1, 'name': 'plain', 'params': [{'name': 'x'}, {'name': 'x'}], 'actions': []}",
        "{'status': 'ok'}");
    const auto info = twice.info();
    CHECK(info.name == "");
    CHECK(info.version.find("`x` is declared twice") != std::string::npos);
    CHECK(info.version.find("adapter-check") != std::string::npos);
    CHECK(twice.reset({}, 1).status == SimStatus::kLost);
  }
  auto slow = answering(hello, "{'status': 'ok', 'sim_time': 90}");
  CHECK(slow.reset({}, 1).status == SimStatus::kOk);
  const auto outcome = slow.act("push", {}, 60.0);
  CHECK(outcome.status == SimStatus::kLost);
  CHECK(outcome.reason.find("`push` ran 90 s with a limit of 60 s") != std::string::npos);
  CHECK(slow.act("push", {}, 60.0).status == SimStatus::kLost);  // it was ended
}

}  // namespace
}  // namespace parallax::harness
