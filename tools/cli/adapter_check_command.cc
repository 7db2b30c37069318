#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <sstream>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/subprocess.h"
#include "harness/campaign/start_states.h"
#include "harness/conformance/conformance.h"
#include "tools/app/scenario_check.h"
#include "tools/app/scenario_model.h"
#include "tools/app/trace_feed.h"
#include "tools/cli/command.h"
#include "tools/cli/limits.h"

namespace parallax::tools {
namespace {

constexpr std::uint64_t kDrawSeed = 1;

struct AdapterCheckOptions {
  std::vector<std::string> command, actions;
  std::string scenario;
  // 0: as the scenario or the protocol has it
  double request_limit_s = 0.0, start_limit_s = 0.0;
  double tolerance = 1e-3;
};

harness::Value value_of_word(const std::string& word) {
  if (word == "true" || word == "false") return word == "true";
  const char* end = word.data() + word.size();
  std::int64_t integer = 0;
  const auto whole = std::from_chars(word.data(), end, integer);
  if (whole.ec == std::errc() && whole.ptr == end) return integer;
  double number = 0.0;
  const auto read = std::from_chars(word.data(), end, number);
  if (read.ec == std::errc() && read.ptr == end && std::isfinite(number)) return number;
  return word;
}

/// "drive target.x=1.5 arm=left".
base::Result<harness::TriedAction> tried_action(const std::string& text,
                                                base::DiagnosticSink& sink) {
  harness::TriedAction action;
  std::istringstream words(text);
  words >> action.controller;
  for (std::string word; words >> word;) {
    const auto equals = word.find('=');
    if (equals == std::string::npos || equals == 0) {
      return sink.error_about(codes::kUsage, "--act",
                              fmt::format("`{}` is no NAME=VALUE of an argument", word));
    }
    action.arguments[word.substr(0, equals)] = value_of_word(word.substr(equals + 1));
  }
  if (action.controller.empty()) {
    return sink.error_about(codes::kUsage, "--act", "it names no action");
  }
  return action;
}

/// Limits of the requests as the options have them, longer or shorter than the scenario's.
void set_limits(const AdapterCheckOptions& options, harness::ProcessOptions& process) {
  if (options.request_limit_s > 0.0) {
    for (auto* limit : {&process.hello_timeout_s, &process.reset_timeout_s, &process.act_timeout_s,
                        &process.observe_timeout_s, &process.close_timeout_s}) {
      *limit = options.request_limit_s;
    }
  }
  if (options.start_limit_s > 0.0) {
    process.hello_timeout_s = process.reset_timeout_s = options.start_limit_s;
  }
}

/// At most so many initial states of the trace are tried, with a start each.
constexpr std::int64_t kMostTriedStates = 10;

/// Starts and actions of the scenario's first trace: two starts from its first initial state, and
/// one from each other.
base::Status take_trace(const ScenarioModel& loaded, harness::ConformanceOptions& options,
                        const harness::ModelFluents& fluents, harness::TraceFeed& traces,
                        Invocation& invocation) {
  const auto trace = traces.next();
  if (!trace) return invocation.sink().already_reported();
  if (!*trace) {
    return invocation.sink().error_about(codes::kUsage, loaded.scenario.file.string(),
                                         "the scenario has no trace to take actions from");
  }
  const harness::SimulatorInfo unknown;
  auto states = harness::StartStates::make(
      {loaded.scenario, fluents, unknown, traces, invocation.sink(), kDrawSeed}, **trace);
  if (!states) return invocation.sink().already_reported();
  for (const auto& call : states->first().calls) {
    options.actions.push_back({call.controller, call.arguments, call.time_limit_s});
  }
  std::uint64_t sample = 0;
  const auto draw = [&](const harness::TracePlan& plan) {
    options.starts.push_back(
        plan.sampler.draw({kDrawSeed, plan.trace_key, harness::DrawPhase::kCertify, ++sample, 0}));
  };
  draw(states->first());
  draw(states->first());
  if (states->is_single()) return base::Unit{};
  std::int64_t tried = 1;
  const auto last = std::min(states->count().value_or(1), kMostTriedStates);
  for (std::int64_t state = 2; state <= last; ++state) {
    const auto start = states->prepared(state);
    if (!start) return invocation.sink().already_reported();
    if (!*start) break;  // stopped
    draw(*(*start)->plan);
    ++tried;
  }
  harness::StartResult about;
  states->describe(about, 0);
  options.states = {about.all, tried};
  return base::Unit{};
}

int tell(const harness::ConformanceOptions& options, Invocation& invocation) {
  const auto command = options.process.command;
  auto started = options;
  // Everything that the adapter starts and leaves behind ends with the check.
  started.process.command.insert(started.process.command.begin(),
                                 {"/proc/self/exe", "supervise", "--"});
  const auto report = harness::check_conformance(started);
  if (invocation.sink().has_errors()) return 0;
  if (invocation.options().json) {
    invocation.document(harness::conformance_json(report, command));
  } else {
    invocation.result(harness::conformance_text(report, base::command_text(command)));
  }
  if (report.faults() > 0) return 1;
  return report.complete ? 0 : 4;
}

int check_with_scenario(const AdapterCheckOptions& options, harness::ConformanceOptions& check,
                        Invocation& invocation) {
  const auto loaded = load_scenario_model(options.scenario, invocation);
  if (!loaded) return 0;
  const auto& scenario = loaded->scenario;
  auto& sink = invocation.sink();
  if (!loaded->compilation.model.has_constraints) {
    sink.error(codes::kNothingToSimulate, base::SourceRange{scenario.source, 0, 0});
    return 0;
  }
  static_cast<harness::ProcessLimits&>(check.process) = scenario.simulator;
  set_limits(options, check.process);
  if (check.process.command.empty()) check.process.command = scenario.simulator.command;
  if (check.process.command.empty()) {
    sink.error_about(codes::kUsage, options.scenario,
                     "the scenario names no command; add one behind --");
    return 0;
  }
  EnumeratedTraces traces(*loaded, invocation);
  traces.explain_absence_by([&] { return reasons_for_absence(*loaded, invocation); });
  const harness::ModelFluents fluents(*traces.symbols());
  if (!take_trace(*loaded, check, fluents, traces, invocation)) return 0;
  check.on_info = [&](const harness::SimulatorInfo& info) {
    return static_cast<bool>(
        harness::check_against_simulator(scenario, fluents.ground(), info, sink));
  };
  if (options.command.empty()) {
    invocation.remark(fmt::format("starting `{}`, as {} says",
                                  base::command_text(check.process.command),
                                  invocation.files().place(scenario.simulator.source)));
  }
  return tell(check, invocation);
}

int run_adapter_check(const AdapterCheckOptions& options, Invocation& invocation) {
  harness::ConformanceOptions check;
  check.process.command = options.command;
  check.process.stop = &stop_flag();
  check.tolerance = options.tolerance;
  for (const auto& text : options.actions) {
    auto action = tried_action(text, invocation.sink());
    if (!action) return 0;
    check.actions.push_back(*std::move(action));
  }
  if (!options.scenario.empty() && !options.actions.empty()) {
    invocation.sink().error_about(codes::kUsage, "--act",
                                  "actions are those of the scenario; leave one of the two out");
    return 0;
  }
  if (!options.scenario.empty()) return check_with_scenario(options, check, invocation);
  if (options.command.empty()) {
    invocation.sink().error_about(codes::kUsage, "",
                                  "name the command of a simulator, or a --scenario");
    return 0;
  }
  set_limits(options, check.process);
  return tell(check, invocation);
}

}  // namespace

Command adapter_check_command() {
  auto options = std::make_shared<AdapterCheckOptions>();
  OptionTable command("adapter-check",
                      "Does a simulator of others keep the protocol, and which claims does it "
                      "support?");
  command.footer(
      "Examples:\n"
      "  parallax adapter-check python3 my_adapter.py\n"
      "  parallax adapter-check --act \"drive target.x=1.5\" -- ./my_adapter --port 3000\n"
      "  parallax adapter-check --scenario fetch.yaml     its command, starts and actions\n"
      "Exit codes: 0 no fault, 1 faults, 2 usage, 3 a scenario that does not fit, 4 interrupted.");
  command
      .option("command", options->command,
              "The simulator: a program and its arguments, behind -- if these have dashes")
      .program();
  command
      .option("--scenario", options->scenario,
              "Check it against this scenario: variables, starts and actions are its own")
      .file({"yaml"});
  command
      .option("--act", options->actions,
              "An action to try, \"NAME ARGUMENT=VALUE ...\"; may be repeated")
      .details(
          "Actions are tried in the order given. Default: those that the simulator says how to "
          "call.")
      .list(ListForm::kOneEachTime);
  command
      .option("--tolerance", options->tolerance,
              "By how much starts and repeated runs may deviate, in the unit of each variable")
      .check(FiniteNumber{0.0, 1e3})
      .show_default();
  command
      .option("--request-limit", options->request_limit_s,
              "Longest time of each request, in seconds of wall time; may lengthen limits")
      .details("Default: as the scenario says, or docs/reference/protocol.md.")
      .check(FiniteNumber{0.01, 1e5});
  command
      .option("--start-limit", options->start_limit_s,
              "The same for `hello` and `reset` alone, for worlds that take long to load")
      .check(FiniteNumber{0.01, 1e5});
  return command_of(std::move(command), options, run_adapter_check);
}

}  // namespace parallax::tools
