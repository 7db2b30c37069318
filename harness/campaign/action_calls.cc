#include <algorithm>
#include <optional>
#include <string>

#include "compiler/base/diagnostic_codes.h"
#include "harness/campaign/sample_runner.h"
#include "harness/region/state_mapping.h"
#include "harness/world/controller_table.h"

namespace parallax::harness {
namespace {

/// What the controller calls an argument of the plan; none if it is not taken.
std::optional<std::string> taken_as(const ActionBinding& binding, const std::string& name) {
  if (!binding.from_plan) return name;
  for (const auto& [from, to] : *binding.from_plan) {
    if (name == from) return to;
    if (name.starts_with(from + ".")) return to + name.substr(from.size());
  }
  return std::nullopt;
}

ActionCall call_for(const ActionBinding& binding, const TraceEvent& event) {
  const GroundFluent ground{event.text, event.symbol, event.arguments};
  ActionCall call{binding.controller, binding.arguments, binding.time_limit_s};
  for (auto& [name, value] : call.arguments) {
    if (auto* text = std::get_if<std::string>(&value)) *text = with_arguments(*text, ground);
  }
  for (const auto& [name, value] : event.plan_arguments) {
    if (const auto taken = taken_as(binding, name)) call.arguments[*taken] = value;
  }
  return call;
}

void check_required(const ActionBinding& binding, const TraceEvent& event, const ActionCall& call,
                    base::DiagnosticSink& sink) {
  const auto* controller = find_controller(call.controller);
  if (controller == nullptr) return;  // reported when the scenario was held against the simulator
  for (const auto& argument : controller->arguments) {
    if (!argument.required || call.arguments.contains(std::string(argument.name))) continue;
    sink.error(base::DiagnosticCode::kMissingArgument, binding.source, event.text, call.controller,
               argument.name);
  }
}

}  // namespace

base::Result<std::vector<ActionCall>> action_calls(const Scenario& scenario,
                                                   const CampaignTrace& trace,
                                                   base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  std::vector<ActionCall> calls;
  for (const auto& event : trace.events) {
    const auto binding =
        std::find_if(scenario.actions.begin(), scenario.actions.end(),
                     [&](const ActionBinding& a) { return a.event == event.symbol; });
    if (binding == scenario.actions.end()) {
      sink.error(base::DiagnosticCode::kEventWithoutAction, scenario.actions_source, event.symbol);
      continue;
    }
    calls.push_back(call_for(*binding, event));
    if (scenario.simulator.command.empty()) check_required(*binding, event, calls.back(), sink);
  }
  if (sink.error_count() != errors_before) return sink.already_reported();
  return calls;
}

}  // namespace parallax::harness
