#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "compiler/base/diagnostic_codes.h"
#include "harness/config/sections.h"
#include "harness/world/arguments.h"
#include "harness/world/controller_table.h"

namespace parallax::harness {
namespace {

using base::DiagnosticCode;

constexpr double kPlay_m = 0.005;  // stops give a little

bool depends_on_event(const std::string& text) { return text.find('{') != std::string::npos; }

class NameChecker {
 public:
  NameChecker(const Scenario& scenario, base::DiagnosticSink& sink)
      : scenario_(scenario), layout_(lay_out(scenario.world)), sink_(sink) {}

  /// `event` is none for what is the same in all events.
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
    auto error = sink_.error(DiagnosticCode::kUnknownController, action.source, action.controller);
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
    auto error = sink_.error(DiagnosticCode::kBadWorld,
                             action.argument_sources.at(std::string(argument.name)),
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

}  // namespace

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

void check_ranges(const Scenario& scenario, const std::vector<GroundFluent>& fluents,
                  base::DiagnosticSink& sink) {
  const auto layout = lay_out(scenario.world);
  std::set<std::string> reported;
  for (const auto& fluent : fluents) {
    const auto* binding = scenario.mapping->find(fluent.symbol);
    const auto* range =
        binding == nullptr ? nullptr : std::get_if<RangeBinding>(&binding->condition);
    if (range == nullptr) continue;
    auto variable = with_arguments(range->variable, fluent);
    if (!variable.ends_with(".q")) continue;
    const auto slider =
        layout.find_slider(std::string_view(variable).substr(0, variable.size() - 2));
    if (!slider) continue;
    const JointSpec& joint = layout.sliders[*slider];
    for (const auto& [key, interval] :
         {std::pair{Key::kHolds, &range->holds}, std::pair{Key::kFails, &range->fails}}) {
      const bool met = (!joint.high_m || interval->lower <= *joint.high_m + kPlay_m) &&
                       (!joint.low_m || interval->upper >= *joint.low_m - kPlay_m);
      if (met || !reported.insert(fluent.symbol + std::string(key)).second) continue;
      sink.error(
          DiagnosticCode::kBadWorld, binding->source,
          fmt::format("mapping/{}/{}", fluent.symbol, key),
          fmt::format("is from {:g} to {:g}, which `{}` never reaches: it moves from {} to {}",
                      interval->lower, interval->upper, joint.name,
                      joint.low_m ? fmt::format("{:g}", *joint.low_m) : "anywhere below",
                      joint.high_m ? fmt::format("{:g}", *joint.high_m) : "anywhere above"));
    }
  }
}

}  // namespace parallax::harness
