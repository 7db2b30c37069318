#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

#include "compiler/base/diagnostic_codes.h"
#include "harness/campaign/sample_runner.h"
#include "harness/region/state_mapping.h"
#include "harness/world/arguments.h"
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

/// What the built-in simulator's controller would refuse. False if it was reported.
bool check_required(const ActionBinding& binding, const TraceEvent& event, const ActionCall& call,
                    const ControllerSpec& controller, base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  for (const auto& argument : controller.arguments) {
    if (!argument.required || call.arguments.contains(std::string(argument.name))) continue;
    sink.error(base::DiagnosticCode::kMissingArgument, binding.source, event.text, call.controller,
               argument.name);
  }
  return sink.error_count() == errors_before;
}

/// Values that the plan gave, and what they make of those of the scenario.
class ValueChecker {
 public:
  explicit ValueChecker(const WorldSpec& world) : world_(world), layout_(lay_out(world)) {}

  void check(const ActionBinding& binding, const TraceEvent& event, const ActionCall& call,
             const ControllerSpec& controller, base::DiagnosticSink& sink) const {
    const auto report = [&](const std::string& name, const std::string& fault) {
      const auto own = binding.argument_sources.find(name);
      const auto place = own == binding.argument_sources.end() ? binding.source : own->second;
      auto error = sink.error(base::DiagnosticCode::kBadWorld, place,
                              fmt::format("actions/{}/{}", binding.event, name), fault);
      error.note(event.source.empty()
                     ? fmt::format("for the event `{}`", event.text)
                     : fmt::format("for the event `{}` of {}", event.text, event.source));
    };
    for (const auto& [name, value] : call.arguments) {
      const auto* argument = find_argument(controller, name);
      const auto fault =
          argument == nullptr ? std::string("is none that it takes") : fault_of(*argument, value);
      if (!fault.empty()) return report(name, fault);
    }
    if (const auto fault = wrong_together(controller, call.arguments)) {
      report(fault->name, fault->text);
    }
  }

 private:
  std::string fault_of(const ArgumentSpec& argument, const Value& value) const {
    if (is_name(argument)) {
      const auto* text = std::get_if<std::string>(&value);
      return text == nullptr ? "is not a name" : wrong_name(argument, *text, world_, layout_);
    }
    const auto number = as_number(value);
    return number ? wrong_number(argument, *number) : "is not a number";
  }

  const WorldSpec& world_;
  WorldLayout layout_;
};

}  // namespace

base::Result<std::vector<ActionCall>> action_calls(const Scenario& scenario,
                                                   const CampaignTrace& trace,
                                                   base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  const bool built_in = scenario.simulator.command.empty();
  const ValueChecker values(scenario.world);
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
    const auto& call = calls.back();
    // Another one was reported when the scenario was held against the simulator.
    const auto* controller = built_in ? find_controller(call.controller) : nullptr;
    if (controller == nullptr) continue;
    if (check_required(*binding, event, call, *controller, sink)) {
      values.check(*binding, event, call, *controller, sink);
    }
  }
  if (sink.error_count() != errors_before) return sink.already_reported();
  return calls;
}

}  // namespace parallax::harness
