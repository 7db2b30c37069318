#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "compiler/base/codes/scenarios.h"
#include "harness/config/sections.h"
#include "harness/world/world_layout.h"

// Checks of mappings against the stops of drawers and doors: a range must be reachable, and what
// an event is to bring about must hold at the stop that its controller leads to.

namespace parallax::harness {

namespace {

constexpr double kPlay_m = 0.005;  // stops give a little

struct Stops {
  std::string_view name;
  std::optional<double> low, high;  // [m], or [rad] of a hinge
};

std::optional<Stops> stops_of(const WorldLayout& layout, std::string_view name) {
  if (const auto slider = layout.find_slider(name)) {
    const JointSpec& joint = layout.sliders[*slider];
    return Stops{joint.name, joint.low_m, joint.high_m};
  }
  if (const auto hinge = layout.find_hinge(name)) {
    const JointSpec& joint = layout.hinges[*hinge];
    return Stops{joint.name, joint.low_rad, joint.high_rad};
  }
  return std::nullopt;
}

/// The stop that the controller leads a joint to; none where it leads none.
std::optional<double> goal_of(std::string_view controller, const Stops& stops) {
  if (controller == "open-drawer" || controller == "open-door") return stops.high;
  if (controller == "close-drawer" || controller == "close-door") return stops.low;
  return std::nullopt;
}

/// The value of `variable` where the joint is at `goal`: its own position, or a coordinate of what
/// a slider carries. None for variables that the joint does not determine.
std::optional<double> value_at(const WorldLayout& layout, const std::string& joint, double goal,
                               std::string_view variable) {
  if (variable == joint + ".q") return goal;
  const auto id = layout.find_slider(joint);
  if (!id) return std::nullopt;
  const JointSpec& slider = layout.sliders[*id];
  const auto parent = layout.find_body(slider.parent), child = layout.find_body(slider.child);
  if (!child || (parent && layout.link_of[parent->index()])) return std::nullopt;  // it moves
  static constexpr std::array<std::string_view, 3> kItems = {".x", ".y", ".z"};
  for (int i = 0; i < 3; ++i) {
    if (variable != slider.child + std::string(kItems[static_cast<std::size_t>(i)])) continue;
    const double along = slider.axis_W.normalized()[i];
    if (along == 0.0) return std::nullopt;
    return layout.bodies[*child].p_WB[i] + along * goal;
  }
  return std::nullopt;
}

const ActionBinding* action_for(const Scenario& scenario, const std::string& event) {
  const auto found = std::find_if(scenario.actions.begin(), scenario.actions.end(),
                                  [&](const ActionBinding& one) { return one.event == event; });
  return found == scenario.actions.end() ? nullptr : &*found;
}

/// The joint that the event moves, by the plan or the scenario; empty where neither says.
std::string joint_of(const ActionBinding& action, const CausedFluent& caused) {
  for (const State* given : {&caused.planned, &action.arguments}) {
    const auto found = given->find("joint");
    if (found == given->end()) continue;
    const auto* name = std::get_if<std::string>(&found->second);
    return name == nullptr ? std::string() : with_arguments(*name, caused.event);
  }
  return {};
}

}  // namespace

bool leads_to_stop(const Scenario& scenario, const std::string& event) {
  const auto* action = action_for(scenario, event);
  return action != nullptr && goal_of(action->controller, {"", 0.0, 0.0}).has_value();
}

void check_stops(const Scenario& scenario, const std::vector<CausedFluent>& caused,
                 base::DiagnosticSink& sink) {
  const auto layout = lay_out(scenario.world);
  std::set<std::string> reported;
  for (const CausedFluent& one : caused) {
    const auto* action = action_for(scenario, one.event.symbol);
    const auto* binding = scenario.mapping->find(one.fluent.symbol);
    const auto* range =
        binding == nullptr ? nullptr : std::get_if<RangeBinding>(&binding->condition);
    if (action == nullptr || range == nullptr) continue;
    const auto joint = joint_of(*action, one);
    const auto stops = stops_of(layout, joint);
    const auto stop = stops ? goal_of(action->controller, *stops) : std::nullopt;
    const auto variable = with_arguments(range->variable, one.fluent);
    if (!stop) continue;
    const double at_stop = *stop;
    const auto goal = value_at(layout, joint, at_stop, variable);
    if (!goal) continue;
    const auto lies_in = [&](const Interval& at) {
      return at.lower <= *goal + kPlay_m && *goal <= at.upper + kPlay_m;
    };
    const Interval &wanted = one.holds ? range->holds : range->fails,
                   &other = one.holds ? range->fails : range->holds;
    if (lies_in(wanted) || !lies_in(other) || !reported.insert(one.fluent.symbol).second) continue;
    const auto key = one.holds ? Key::kHolds : Key::kFails;
    const auto where = *goal == at_stop
                           ? fmt::format("{:g}", at_stop)
                           : fmt::format("{:g}, where `{}` is {:g}", at_stop, variable, *goal);
    sink.error(
        codes::kBadWorld, binding->source, fmt::format("mapping/{}/{}", one.fluent.symbol, key),
        fmt::format("is from {:g} to {:g}, but the event `{}` is to make it so that `{}` "
                    "{}, and its controller `{}` leads `{}` to its stop at {}",
                    wanted.lower, wanted.upper, one.event.text, one.fluent.text,
                    one.holds ? "holds" : "does not hold", action->controller, joint, where));
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
    const auto stops = stops_of(layout, std::string_view(variable).substr(0, variable.size() - 2));
    if (!stops) continue;
    for (const auto& [key, interval] :
         {std::pair{Key::kHolds, &range->holds}, std::pair{Key::kFails, &range->fails}}) {
      const bool met = (!stops->high || interval->lower <= *stops->high + kPlay_m) &&
                       (!stops->low || interval->upper >= *stops->low - kPlay_m);
      if (met || !reported.insert(fluent.symbol + std::string(key)).second) continue;
      sink.error(
          codes::kBadWorld, binding->source, fmt::format("mapping/{}/{}", fluent.symbol, key),
          fmt::format("is from {:g} to {:g}, which `{}` never reaches: it moves from {} to {}",
                      interval->lower, interval->upper, stops->name,
                      stops->low ? fmt::format("{:g}", *stops->low) : "anywhere below",
                      stops->high ? fmt::format("{:g}", *stops->high) : "anywhere above"));
    }
  }
}

}  // namespace parallax::harness
