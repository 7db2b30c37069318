#include "tools/doctor/trials.h"

#include <fmt/format.h>

#include <chrono>
#include <csignal>
#include <cstring>

#include "compiler/base/diagnostic.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "compiler/base/source_file.h"
#include "tools/scaffold/scaffold.h"

namespace parallax::tools {
namespace {

constexpr auto kLongestTrial = std::chrono::seconds(30);
constexpr std::size_t kMaxMessageBytes = std::size_t{16} << 10U;

/// A lamp that may be switched at timepoints 0, 1 and 2 or not: 2^3 traces, and no other.
constexpr const char* kLamp =
    "fluent On()\n"
    "event Switch()\n"
    "[time] !HoldsAt(On(),time) -> Initiates(Switch(),On(),time).\n"
    "[time] HoldsAt(On(),time) -> Terminates(Switch(),On(),time).\n"
    "!HoldsAt(On(),0).\n"
    "range time 0 3\n"
    "range offset 1 1\n";
constexpr std::int64_t kLampTraces = 8;
constexpr std::int64_t kSimulations = 2;

/// -1 if it is malformed.
template <typename Json>
std::int64_t whole_number(const Json* value) {
  return value == nullptr ? -1 : base::json_as<std::int64_t>(*value).value_or(-1);
}

/// Why a child gave no answer, in a few words.
std::string failure_of(const base::Captured& child) {
  if (child.code < 0) return fmt::format("it cannot be started: {}", std::strerror(child.error));
  if (child.code == 128 + SIGKILL) return "it was killed, or took longer than 30 s";
  if (child.code > 128) return fmt::format("it ended with signal {}", child.code - 128);
  const auto first = child.err.substr(0, child.err.find('\n'));
  return fmt::format("it ended with code {}{}{}", child.code, first.empty() ? "" : ": ", first);
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

CheckUp broken(CheckUp check, std::string found) {
  check.health = Health::kBroken;
  check.found = std::move(found);
  if (check.remedy.empty()) check.remedy = "install the program again, or build it on this machine";
  return check;
}

/// A program that some commands call: works if it ends with 0.
CheckUp try_program(CheckUp check, const TrialRunner& runner,
                    const std::vector<std::string>& command) {
  if (runner.is_stopped()) return check;
  check.is_needed = false;
  const auto child = runner.run(command);
  if (child.code == 0) {
    check.health = Health::kWorks;
    check.found = first_line(child.out);
    check.remedy.clear();
    return check;
  }
  check.health = child.code < 0 ? Health::kAbsent : Health::kBroken;
  check.found = child.code < 0 ? "not found" : failure_of(child);
  return check;
}

}  // namespace

base::Captured TrialRunner::run(const std::vector<std::string>& command,
                                const std::string& program) const {
  base::CaptureOptions options;
  options.program = program;
  options.folder = folder_.string();
  options.ends_with_us = true;
  options.without_input = true;
  options.max_errors = kMaxMessageBytes;
  const auto deadline = std::chrono::steady_clock::now() + kLongestTrial;
  options.signal_when = [this, deadline, told = false]() mutable {
    if (std::chrono::steady_clock::now() > deadline) return SIGKILL;
    if (told || !stop_.load()) return 0;
    told = true;
    return SIGTERM;
  };
  return base::capture(command, options);
}

base::Captured TrialRunner::run_parallax(std::vector<std::string> arguments) const {
  arguments.insert(arguments.begin(), "parallax");
  arguments.insert(arguments.end(), {"--json", "--quiet", "--color=never"});
  return run(arguments, "/proc/self/exe");
}

bool TrialRunner::write(const std::string& name, const std::string& text) const {
  base::DiagnosticSink sink;
  return static_cast<bool>(base::write_file_atomically(folder_ / name, text, sink));
}

CheckUp try_solver(const TrialRunner& runner) {
  CheckUp check{.name = "solver"};
  if (runner.is_stopped()) return check;
  if (!runner.write("lamp.e", kLamp)) return broken(check, "its model cannot be written");
  const auto child =
      runner.run_parallax({"traces", "lamp.e", "--limit", "0", "--certify=lamp.drat"});
  if (runner.is_stopped()) return check;
  if (child.code != 0) return broken(check, "a model of 8 traces: " + failure_of(child));
  const auto document = base::parse_json(child.out);
  const auto found = whole_number(base::json_member(document, "traces"));
  if (found != kLampTraces) {
    return broken(check, fmt::format("a model of {} traces: it gave {}", kLampTraces, found));
  }
  const auto* proof = base::json_member(document, "proof");
  if (proof == nullptr || base::json_as<std::string>(*proof) != "checked") {
    return broken(check, fmt::format("a model of {} traces: no proof was checked that there is no "
                                     "other",
                                     kLampTraces));
  }
  check.health = Health::kWorks;
  check.found = fmt::format("all {} traces of a model, and a checked proof that there is no other",
                            kLampTraces);
  return check;
}

CheckUp try_simulator(const TrialRunner& runner) {
  CheckUp check{.name = "simulator"};
  if (runner.is_stopped()) return check;
  base::DiagnosticSink sink;
  const base::SourceFiles files;
  if (!write_scaffold((runner.folder() / "line").string(),
                      scaffold_files("line", scaffold_kinds().front()), files, sink)) {
    return broken(check, "its scenario cannot be written");
  }
  const auto child = runner.run_parallax(
      {"rates", "line/scenario.yaml", "--runs", std::to_string(kSimulations), "--jobs", "2"});
  if (runner.is_stopped()) return check;
  if (child.code != 0) return broken(check, "a robot that fetches a box: " + failure_of(child));
  const auto document = base::parse_json(child.out);
  const auto* traces = base::json_member(document, "traces");
  std::int64_t runs = -1;
  std::int64_t discrepancies = -1;
  if (traces != nullptr && traces->is_array() && !traces->empty()) {
    const auto& trace = traces->front();
    runs = whole_number(base::json_member(trace, "runs"));
    if (const auto* any = base::json_member(trace, "any")) {
      discrepancies = whole_number(base::json_member(*any, "count"));
    }
  }
  if (runs != kSimulations || discrepancies != 0) {
    return broken(check, fmt::format("a robot that fetches a box: {} of {} simulations ended, {} "
                                     "otherwise than they do elsewhere",
                                     runs, kSimulations, discrepancies));
  }
  check.health = Health::kWorks;
  check.found =
      fmt::format("{} simulations of a robot that fetches a box, by workers (ode)", kSimulations);
  return check;
}

CheckUp try_git(const TrialRunner& runner) {
  return try_program(
      {.name = "git", .remedy = "needed by `bisect` and histories of suites", .package = "git"},
      runner, {"git", "--version"});
}

CheckUp try_python(const TrialRunner& runner) {
  auto check = try_program(
      {.name = "python3",
       .remedy = "needed by simulators in Python (docs/guide/simulators.md), from 3.8 on",
       .package = "python3"},
      runner,
      {"python3", "-c",
       "import json, sys; assert sys.version_info >= (3, 8); "
       "print('Python', sys.version.split()[0])"});
  return check;
}

}  // namespace parallax::tools
