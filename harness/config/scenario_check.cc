#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "compiler/base/codes/scenarios.h"
#include "harness/config/sections.h"
#include "harness/config/variable_check.h"
#include "harness/world/arguments.h"
#include "harness/world/world_layout.h"

namespace parallax::harness {

namespace {

std::vector<std::string> names_of(const std::vector<Parameter>& parameters) {
  std::vector<std::string> names;
  for (const auto& parameter : parameters) names.push_back(parameter.name);
  return names;
}

/// The nearest of the variables of the same owner, else of those of the same item, else of all.
void add_variable_suggestion(base::DiagnosticBuilder& error, const std::string& variable,
                             const std::vector<std::string>& known) {
  const auto dot = std::min(variable.find('.'), variable.size());
  const auto owner = variable.substr(0, dot) + '.', item = variable.substr(dot);
  std::vector<std::string> same_owner, same_item;
  for (const auto& name : known) {
    if (name.starts_with(owner)) same_owner.push_back(name);
    if (name.ends_with(item)) same_item.push_back(name);
  }
  const auto& near = !same_owner.empty() ? same_owner : !same_item.empty() ? same_item : known;
  add_suggestion(error, variable, near, "variables");
}

void check_event(const Scenario& scenario, const GroundFluent& event, base::DiagnosticSink& sink) {
  const auto action = std::find_if(scenario.actions.begin(), scenario.actions.end(),
                                   [&](const ActionBinding& a) { return a.event == event.symbol; });
  if (action == scenario.actions.end()) {
    std::vector<std::string> known;
    for (const auto& binding : scenario.actions) known.push_back(binding.event);
    auto error = sink.error(codes::kEventWithoutAction, scenario.actions_source, event.symbol);
    add_suggestion(error, event.symbol, known, "actions");
  } else if (action->arity != event.arguments.size()) {
    sink.error(codes::kActionArity, action->source, event.text, event.arguments.size(),
               event.symbol, action->arity);
  }
}

/// Checks that everything a suite waits for can diverge.
void check_expected_names(const Scenario& scenario, const std::vector<GroundFluent>& fluents,
                          const std::vector<std::string>& events, base::DiagnosticSink& sink) {
  if (!scenario.expect) return;
  const auto& expect = *scenario.expect;
  std::vector<std::string> known;
  for (const auto& fluent : fluents) {
    known.push_back(fluent.text);
    const auto outside = scenario.mapping->outside_text(fluent);
    if (!outside.empty()) known.push_back(outside);
  }
  const auto is_known = [](const std::string& text, const std::vector<std::string>& names) {
    return text.empty() || std::find(names.begin(), names.end(), text) != names.end();
  };
  const auto check_fluent = [&](const std::string& text, const base::SourceRange& source) {
    if (is_known(text, known)) return;
    auto error = sink.error(codes::kExpectedFluentUnknown, source, text);
    add_suggestion(error, text, known, "fluents");
  };
  for (const auto& text : expect.fluents) check_fluent(text, expect.fluents_source);
  for (const auto* cause : {expect.cause ? &*expect.cause : nullptr,
                            expect.rate && expect.rate->cause ? &*expect.rate->cause : nullptr}) {
    if (cause == nullptr) continue;
    check_fluent(cause->fluent, cause->fluent_source);
    if (is_known(cause->event, events)) continue;
    auto error = sink.error(codes::kExpectedEventUnknown, cause->event_source, cause->event);
    add_suggestion(error, cause->event, events, "events");
  }
}

/// Entries that nothing in the model answers to are most likely misspelt.
void warn_of_unused(const Scenario& scenario, const std::set<std::string>& fluents,
                    const std::set<std::string>& events, base::DiagnosticSink& sink) {
  const std::vector<std::string> fluent_names(fluents.begin(), fluents.end());
  const std::vector<std::string> event_names(events.begin(), events.end());
  for (const auto& binding : scenario.mapping->bindings()) {
    if (fluents.contains(binding.fluent)) continue;
    auto warning = sink.warning(codes::kUnusedMapping, binding.source, binding.fluent);
    add_suggestion(warning, binding.fluent, fluent_names, "fluents");
  }
  for (const auto& action : scenario.actions) {
    if (events.contains(action.event)) continue;
    auto warning = sink.warning(codes::kUnusedAction, action.source, action.event);
    add_suggestion(warning, action.event, event_names, "events");
  }
}

bool depends_on_event(const std::string& text) { return text.find('{') != std::string::npos; }

class NameChecker {
 public:
  NameChecker(const Scenario& scenario, base::DiagnosticSink& sink)
      : scenario_(scenario), layout_(lay_out(scenario.world)), sink_(sink) {}

  /// Checks the names in arguments that depend on the event; without `event`, those in arguments
  /// that are the same for all events.
  void check(const ActionBinding& action, const GroundFluent* event) {
    const auto* controller = find_controller(action.controller);
    if (controller == nullptr) return;  // reported when it was read
    if (event == nullptr && !fits_robot(action, *controller)) return;
    for (const auto& [name, value] : action.arguments) {
      const auto* argument = find_argument(*controller, name);
      const auto* text = std::get_if<std::string>(&value);
      if (argument == nullptr || text == nullptr || !is_name(*argument)) continue;
      if (depends_on_event(*text) != (event != nullptr)) continue;
      check(action, *argument, event == nullptr ? *text : with_arguments(*text, *event), event);
    }
    // Where the joint depends on the event, the calls of a trace tell.
    const auto fault = event == nullptr ? wrong_tolerance(*controller, action.arguments, layout_)
                                        : std::optional<ArgumentFault>();
    if (!fault) return;
    sink_.error(codes::kBadWorld, action.argument_sources.at(fault->name),
                fmt::format("actions/{}/{}", action.event, fault->name), fault->text);
  }

 private:
  bool fits_robot(const ActionBinding& action, const ControllerSpec& controller) {
    const auto can = [&](const ControllerSpec& one) {
      return one.robot == RobotKind::kMobile ? scenario_.world.mobile.has_value()
                                             : !scenario_.world.robot.base_body.empty();
    };
    if (can(controller)) return true;
    std::vector<std::string> known;
    for (const auto& one : controllers()) {
      if (can(one)) known.emplace_back(one.name);
    }
    auto error = sink_.error(codes::kUnknownController, action.source, action.controller);
    error.note(known.empty() ? "the world has no robot" : "the robot is of another kind");
    add_suggestion(error, action.controller, known, "controllers");
    return false;
  }

  void check(const ActionBinding& action, const ArgumentSpec& argument, const std::string& name,
             const GroundFluent* event) {
    if (!seen_.emplace(action.event, std::string(argument.name), name).second) return;
    const auto fault = wrong_name(argument, name, scenario_.world, layout_);
    // One instance says what is wrong with all of them.
    if (fault.empty() || !reported_.emplace(action.event, argument.name).second) return;
    auto error =
        sink_.error(codes::kBadWorld, action.argument_sources.at(std::string(argument.name)),
                    fmt::format("actions/{}/{}", action.event, argument.name), fault);
    if (event != nullptr) error.note(fmt::format("for the event `{}`", event->text));
    add_suggestion(error, name, names_for(argument, scenario_.world, layout_), "names");
  }

  const Scenario& scenario_;
  WorldLayout layout_;
  base::DiagnosticSink& sink_;
  std::set<std::tuple<std::string, std::string, std::string>> seen_;
  std::set<std::pair<std::string, std::string_view>> reported_;
};

/// The variables that depend on a fluent's arguments, `{item}.held_by.{arm}`: one message for an
/// entry, about its first fluent that cannot be read.
/// The place of the region's frame, where only the simulator knows that body.
void add_frame_variables(const Scenario& scenario, const FluentBinding& binding,
                         const GroundFluent& fluent, std::vector<std::string>& variables) {
  if (scenario.simulator.is_built_in() || binding.inside() == nullptr) return;
  const auto* region = binding.inside()->region_of(fluent, scenario.mapping->regions());
  if (region == nullptr || region->frame.empty()) return;
  for (const auto* item : {".x", ".y", ".z", ".yaw"}) variables.push_back(region->frame + item);
}

void check_fluent_variables(const Scenario& scenario, const std::vector<GroundFluent>& fluents,
                            const std::vector<Parameter>& parameters, base::DiagnosticSink& sink) {
  check_kinds(scenario, fluents, parameters, sink);
  const auto known = names_of(parameters);
  const std::set<std::string> index(known.begin(), known.end());
  std::set<std::string> reported;
  for (const auto& fluent : fluents) {
    const auto* binding = scenario.mapping->find(fluent.symbol);
    if (binding == nullptr || binding->is_ignored() || reported.contains(fluent.symbol)) continue;
    auto variables = binding->variables(fluent, scenario.mapping->regions());
    add_frame_variables(scenario, *binding, fluent, variables);
    for (const auto& variable : variables) {
      if (index.contains(variable)) continue;
      reported.insert(fluent.symbol);
      auto error = sink.error(codes::kUnknownSimVariable, binding->source, variable);
      error.note(fmt::format("`{}` is read from it", fluent.text));
      add_variable_suggestion(error, variable, known);
      break;
    }
  }
}

}  // namespace

base::Status check_variables(const Scenario& scenario, const std::vector<Parameter>& parameters,
                             base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  const auto known = names_of(parameters);
  for (const auto& binding : scenario.mapping->bindings()) {
    for (const auto& variable : binding.constant_variables(scenario.mapping->regions())) {
      if (std::find(known.begin(), known.end(), variable) != known.end()) continue;
      auto error = sink.error(codes::kUnknownSimVariable, binding.source, variable);
      add_suggestion(error, variable, known, "variables");
    }
  }
  for (const auto& dimension : scenario.sampling) {
    const auto found = std::find_if(parameters.begin(), parameters.end(), [&](const Parameter& p) {
      return p.name == dimension.variable;
    });
    if (found == parameters.end()) {
      auto error = sink.error(codes::kUnknownSimVariable, scenario.sampled_at(dimension.variable),
                              dimension.variable);
      add_suggestion(error, dimension.variable, known, "variables");
    } else if (!found->settable) {
      sink.error(codes::kVariableNotSettable, scenario.sampled_at(dimension.variable),
                 dimension.variable);
    } else {
      check_angle(dimension, *found, scenario, sink);
    }
  }
  check_law(scenario, parameters, sink);
  check_law_kinds(scenario, parameters, sink);
  if (sink.error_count() != errors_before) return sink.already_reported();
  return base::Unit{};
}

namespace {

/// Where last states are compared, a fluent that asks for every step would silently not get it.
void check_comparisons(const Scenario& scenario, base::DiagnosticSink& sink) {
  if (scenario.comparison() != Comparison::kFinal) return;
  for (const auto& binding : scenario.mapping->bindings()) {
    if (!binding.asks_for_every_step) continue;
    sink.error(codes::kComparisonWithoutEffect, binding.source, binding.fluent);
  }
}

}  // namespace

base::Status check_against_model(const Scenario& scenario, const std::vector<std::string>& fluents,
                                 const std::vector<std::string>& events,
                                 base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  std::vector<GroundFluent> ground;
  std::set<std::string> fluent_symbols, event_symbols;
  for (const auto& text : fluents) {
    ground.push_back(ground_fluent(text));
    fluent_symbols.insert(ground.back().symbol);
  }
  const auto mapped = scenario.mapping->check(ground, scenario.mapping_source, sink);
  const bool compares = std::any_of(ground.begin(), ground.end(), [&](const GroundFluent& fluent) {
    const auto* binding = scenario.mapping->find(fluent.symbol);
    return binding != nullptr && !binding->is_ignored();
  });
  if (mapped && !compares) sink.error(codes::kNothingCompared, scenario.mapping_source);
  check_comparisons(scenario, sink);
  std::vector<GroundFluent> ground_events;
  for (const auto& text : events) {
    ground_events.push_back(ground_fluent(text));
    const auto& event = ground_events.back();
    if (event_symbols.insert(event.symbol).second) check_event(scenario, event, sink);
  }
  if (mapped) check_expected_names(scenario, ground, events, sink);
  if (scenario.simulator.is_built_in() && sink.error_count() == errors_before) {
    check_fluent_variables(scenario, ground, observables(scenario.world), sink);
    check_action_names(scenario, ground_events, sink);
    check_ranges(scenario, ground, sink);
  }
  warn_of_unused(scenario, fluent_symbols, event_symbols, sink);
  if (!mapped || sink.error_count() != errors_before) return sink.already_reported();
  return base::Unit{};
}

namespace {

/// Checks the scenario's arguments for a controller, if the simulator tells what it takes.
/// Arguments from the plan are known when it acts.
void check_arguments(const ActionBinding& action, const SimulatorInfo& info,
                     base::DiagnosticSink& sink) {
  const auto told = info.arguments.find(action.controller);
  if (told == info.arguments.end()) return;
  std::vector<std::string> names;
  for (const auto& argument : told->second) names.push_back(argument.name);
  const auto check = [&](const std::string& name, const base::SourceRange& source) {
    if (std::find(names.begin(), names.end(), name) != names.end()) return;
    auto error = sink.error(codes::kUnknownArgument, source, action.controller, name);
    add_suggestion(error, name, names, "arguments");
  };
  for (const auto& [name, value] : action.arguments) {
    const auto place = action.argument_sources.find(name);
    check(name, place != action.argument_sources.end() ? place->second : action.source);
  }
}

}  // namespace

base::Status check_against_simulator(const Scenario& scenario,
                                     const std::vector<GroundFluent>& fluents,
                                     const SimulatorInfo& info, base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  if (!info.parameters.empty()) {
    if (!check_variables(scenario, info.parameters, sink)) return sink.already_reported();
    check_fluent_variables(scenario, fluents, info.parameters, sink);
  }
  const auto& known = info.actions;
  for (const auto& action : scenario.actions) {
    if (known.empty()) break;
    // One that depends on the event was looked at with the events.
    if (depends_on_event(action.controller)) continue;
    if (std::find(known.begin(), known.end(), action.controller) != known.end()) continue;
    auto error = sink.error(codes::kUnknownController, action.source, action.controller);
    add_suggestion(error, action.controller, known, "controllers");
  }
  for (const auto& action : scenario.actions) check_arguments(action, info, sink);
  if (sink.error_count() != errors_before) return sink.already_reported();
  return base::Unit{};
}

void check_action_names(const Scenario& scenario, const std::vector<GroundFluent>& events,
                        base::DiagnosticSink& sink) {
  NameChecker checker(scenario, sink);
  if (events.empty()) {
    for (const auto& action : scenario.actions) checker.check(action, nullptr);
  }
  for (const auto& event : events) {
    const auto action =
        std::find_if(scenario.actions.begin(), scenario.actions.end(),
                     [&](const ActionBinding& a) { return a.event == event.symbol; });
    if (action != scenario.actions.end()) checker.check(*action, &event);
  }
}

}  // namespace parallax::harness
