#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compiler/base/codes/scenarios.h"
#include "harness/config/sections.h"

namespace parallax::harness {
namespace {

/// `Name({0},{1})`: what has this name and the same arguments in the world.
std::string same_name(const std::string& symbol, std::size_t arity) {
  std::vector<std::string> places;
  for (std::size_t i = 0; i < arity; ++i) places.push_back(fmt::format("{{{}}}", i));
  return fmt::format("{}({})", symbol, fmt::join(places, ","));
}

using Signature = std::pair<std::string, std::size_t>;

Signature signature_of(const GroundFluent& ground) {
  return {ground.symbol, ground.arguments.size()};
}

/// Reports ranges and `equals`: variables of a model are true or false, not numbers or texts.
void check_condition(const FluentBinding& binding, base::DiagnosticSink& sink) {
  const bool range = std::holds_alternative<RangeBinding>(binding.condition);
  if (!range && !std::holds_alternative<EqualsBinding>(binding.condition)) return;
  sink.error(
      codes::kWrongYamlKind, binding.source, fmt::format("the mapping of `{}`", binding.fluent),
      fmt::format("`{}`", range ? Key::kRange : Key::kEquals),
      fmt::format("`{}` or `{}`: what a model shows is true or false", Key::kFlag, Key::kIgnored));
}

/// Binds each fluent of the model that the scenario does not map.
void bind_fluents(Scenario& scenario, const std::vector<std::string>& fluents,
                  const std::set<Signature>& known, base::DiagnosticSink& sink) {
  auto bindings = scenario.mapping->bindings();
  std::set<std::string> mapped;
  for (auto& binding : bindings) {
    mapped.insert(binding.fluent);
    check_condition(binding, sink);
    auto* flag = std::get_if<FlagBinding>(&binding.condition);
    if (flag != nullptr && !flag->drawn) flag->drawn = true;
  }
  for (const auto& text : fluents) {
    const auto fluent = ground_fluent(text);
    if (!mapped.insert(fluent.symbol).second) continue;
    FluentBinding binding;
    binding.fluent = fluent.symbol;
    binding.arity = fluent.arguments.size();
    binding.source = scenario.simulator.source;
    if (known.contains(signature_of(fluent))) {
      binding.condition = FlagBinding{same_name(fluent.symbol, binding.arity), false, true};
    } else {
      binding.condition = IgnoredBinding{"the model of the simulator has no such fluent"};
    }
    bindings.push_back(std::move(binding));
  }
  auto regions = scenario.mapping->regions();
  scenario.mapping.emplace(std::move(regions), std::move(bindings));
}

void bind_events(Scenario& scenario, const std::vector<std::string>& events,
                 const std::vector<std::string>& known, base::DiagnosticSink& sink) {
  const std::set<std::string> index(known.begin(), known.end());
  std::set<std::string> own, reported;
  for (const auto& action : scenario.actions) {
    own.insert(action.event);
    for (const auto& [name, source] : action.argument_sources) {
      sink.error(codes::kUnknownArgument, source, action.controller, name)
          .note("an event of a model takes the arguments that stand in its brackets");
    }
  }
  for (const auto& text : events) {
    const auto event = ground_fluent(text);
    auto action = std::find_if(scenario.actions.begin(), scenario.actions.end(),
                               [&](const auto& a) { return a.event == event.symbol; });
    if (action == scenario.actions.end()) {
      ActionBinding binding;
      binding.event = event.symbol;
      binding.arity = event.arguments.size();
      binding.controller = same_name(event.symbol, binding.arity);
      binding.source = scenario.simulator.source;
      scenario.actions.push_back(std::move(binding));
      action = scenario.actions.end() - 1;
    }
    const auto name = with_arguments(action->controller, event);
    // One instance says what is wrong with all of them.
    if (index.contains(name) || !reported.insert(event.symbol).second) continue;
    if (own.contains(event.symbol)) {
      auto error = sink.error(codes::kUnknownController, action->source, name);
      error.note(fmt::format("for the event `{}`", text));
      add_suggestion(error, name, known, "events of the simulator's model");
    } else {
      auto error = sink.error(codes::kSimulatorLacksEvent, action->source, name);
      add_suggestion(error, name, known, "events");
    }
  }
  std::sort(scenario.actions.begin(), scenario.actions.end(),
            [](const auto& a, const auto& b) { return a.event < b.event; });
}

}  // namespace

base::Status bind_by_name(Scenario& scenario, const std::vector<std::string>& fluents,
                          const std::vector<std::string>& events, const SimulatorInfo& info,
                          base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  std::set<Signature> known;
  for (const auto& parameter : info.parameters) {
    known.insert(signature_of(ground_fluent(parameter.name)));
  }
  bind_fluents(scenario, fluents, known, sink);
  bind_events(scenario, events, info.actions, sink);
  if (sink.error_count() != errors_before) return sink.already_reported();
  return base::Unit{};
}

}  // namespace parallax::harness
