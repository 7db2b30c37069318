// More than five hundred faults of a simulator in one campaign: every one is reported with its
// kind, no finished result is lost, and no process is left.

#include <signal.h>

#include <chrono>
#include <fstream>
#include <map>
#include <sstream>
#include <thread>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

constexpr const char* kStormModel =
    "sort region\nregion goal, start\nfluent BoxIn(region)\nevent Push()\n"
    "[time] Initiates(Push(),BoxIn(goal),time).\n[time] Terminates(Push(),BoxIn(start),time).\n"
    "HoldsAt(BoxIn(start),0).\n!HoldsAt(BoxIn(goal),0).\n[time] Happens(Push(),time).\n";

/// The words of a loss that name each fault.
const std::map<std::string, std::string> kWords = {
    {"abort", "signal 6"},       {"segfault", "signal 11"},   {"exit", "exit status 7"},
    {"flood", "is longer than"}, {"not-finite", "malformed"}, {"noise", "malformed"},
    {"wrong-id", "malformed"},   {"orphan", "exit status 9"}, {"sleep", "no reply to"},
    {"growth", "MiB of memory"}};

bool is_running(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(file, text);
  const auto end = text.rfind(") ");
  return end != std::string::npos && text[end + 2] != 'Z' && text[end + 2] != 'X';
}

struct StormLog {
  std::map<double, std::string> faults;  // by start
  std::vector<pid_t> processes;
};

StormLog storm_log(const std::string& text) {
  StormLog log;
  std::istringstream lines(text);
  for (std::string word; lines >> word;) {
    if (word == "fault") {
      std::string kind;
      double start = 0.0;
      lines >> kind >> start;
      log.faults.emplace(start, kind);
    } else {
      pid_t pid = 0;
      lines >> pid;
      log.processes.push_back(pid);
    }
  }
  return log;
}

}  // namespace

TEST_CASE("five hundred faults are told apart, and cost nothing but themselves") {
  const CliFixture cli;
  cli.write("storm.e", kStormModel);
  cli.write("storm.yaml",
            "model: storm.e\nhorizon: 1\nconstraints: [\"HoldsAt(BoxIn(goal),time)\"]\n"
            "simulator:\n  command: [" PARALLAX_STORM_SIMULATOR
            ", storm.log]\n"
            "  hello_timeout_s: 60\n  reset_timeout_s: 2\n  act_timeout_s: 2\n"
            "  observe_timeout_s: 2\n  memory_mb: 128\n"
            "regions:\n  cells: {goal: {x: [0, 1]}, start: {x: [3, 4]}}\n  gaps: allowed\n"
            "mapping:\n  BoxIn(region): {inside: region, body: box}\n"
            "actions:\n  Push(): {controller: push}\nlimits: {max_lost_in_a_row: 1000}\n");
  const auto report = json_of(
      cli, {"rates", "storm.yaml", "--runs", "1050", "--jobs", "3", "--samples", "storm.jsonl"});
  const auto log = storm_log(cli.read("storm.log"));
  CHECK(log.faults.size() >= 500);

  std::map<std::string, int> told;
  std::size_t rows = 0;
  std::istringstream lines(cli.read("storm.jsonl"));
  for (std::string line; std::getline(lines, line); ++rows) {
    const auto row = Json::parse(line);
    const double start = row.at("state").at("box.x");
    CAPTURE(line);
    const auto fault = log.faults.find(start);
    if (fault == log.faults.end()) {
      CHECK(row.at("outcome") == "clean");
      continue;
    }
    CAPTURE(fault->second);
    CHECK(row.at("outcome") == "lost");
    CHECK(row.at("reason").dump().find(kWords.at(fault->second)) != std::string::npos);
    ++told[fault->second];
  }
  CHECK(rows == 1050);
  CHECK(told.size() == kWords.size());  // each kind was there
  const auto& trace = report.at("traces").at(0);
  CHECK(trace.at("runs").get<std::size_t>() + trace.at("lost").get<std::size_t>() == 1050);
  CHECK(trace.at("lost") == log.faults.size());
  CHECK(trace.at("any").at("count") == 0);

  CHECK(log.processes.size() > 20);
  for (const auto pid : log.processes) {
    for (int wait = 0; is_running(pid) && wait < 3000; ++wait) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    CHECK_FALSE(is_running(pid));
    if (is_running(pid)) ::kill(pid, SIGKILL);
  }
}

}  // namespace parallax::test
