#include "harness/region/measured.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "harness/region/angle_range.h"
#include "harness/region/area.h"

namespace parallax::harness {
namespace {

/// "5.5 mm", "0.31 m"; "0.2 rad" of angles.
std::string size_text(double size, bool is_in_rad) {
  if (is_in_rad) return fmt::format("{:.2g} rad", size);
  if (size >= 0.9995) return fmt::format("{:.2f} m", size);
  return fmt::format("{:.{}f} mm", 1000.0 * size, size < 0.01 ? 1 : 0);
}

/// Four digits, and no noise of an engine about zero.
std::string number_text(double value) {
  return std::abs(value) < 0.00005 ? "0" : fmt::format("{:.4g}", value);
}

std::string bounds_text(const Interval& interval) {
  return fmt::format("[{:.6g}, {:.6g}]", interval.lower, interval.upper);
}

/// How far the value lies outside of the interval; 0 inside.
double excess(const Interval& interval, double value) {
  return std::max({interval.lower - value, value - interval.upper, 0.0});
}

/// "87 mm below [0.4, 0.8]", "within [0.4, 0.8]". A value on a border that belongs to the neighbour
/// is said to be at it.
std::string place_in(const Interval& interval, double value, bool is_in_rad) {
  const auto bounds = bounds_text(interval);
  if (interval.contains(value)) return "within " + bounds;
  const auto outside = excess(interval, value);
  if (outside == 0.0) return "at the border of " + bounds;
  return fmt::format("{} {} {}", size_text(outside, is_in_rad),
                     value < interval.lower ? "below" : "above", bounds);
}

std::string value_text(const Value& value) {
  if (const auto* real = std::get_if<double>(&value)) return number_text(*real);
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *whole);
  if (const auto* truth = std::get_if<bool>(&value)) return *truth ? "true" : "false";
  return '"' + std::get<std::string>(value) + '"';
}

/// "box.held = true"; empty where the state lacks the variable.
std::string assigned(const std::string& variable, const State& state) {
  const auto found = state.find(variable);
  return found == state.end() ? "" : variable + " = " + value_text(found->second);
}

std::optional<double> number_of(const std::string& variable, const State& state) {
  const auto found = state.find(variable);
  if (found == state.end()) return std::nullopt;
  if (const auto* real = std::get_if<double>(&found->second)) return *real;
  if (const auto* whole = std::get_if<std::int64_t>(&found->second)) {
    return static_cast<double>(*whole);
  }
  return std::nullopt;
}

/// The flags that keep the fluent from holding, and how far the body leans beyond what is allowed.
std::string hindrance(const InsideBinding& kind, const Region& region, const GroundFluent& fluent,
                      const State& state) {
  for (const auto& variable : {kind.unless, kind.only_if}) {
    if (!variable) continue;
    auto only_this = kind;
    (variable == kind.unless ? only_this.only_if : only_this.unless).reset();
    if (!only_this.flags_allow(fluent, state, nullptr)) {
      return assigned(with_arguments(*variable, fluent), state);
    }
  }
  const auto& free = kind.upright_except;
  if (!kind.upright || std::find(free.begin(), free.end(), region.name) != free.end()) return {};
  const auto body = with_arguments(kind.body, fluent);
  const auto roll = number_of(body + ".roll", state), pitch = number_of(body + ".pitch", state);
  if (!roll || !pitch) return {};
  const double leans = std::acos(std::clamp(std::cos(*roll) * std::cos(*pitch), -1.0, 1.0));
  if (leans <= *kind.upright) return {};
  return fmt::format("{} leans by {:.2g} rad, more than {:.2g}", body, leans, *kind.upright);
}

std::string measured(const InsideBinding& kind, const GroundFluent& fluent, const State& state,
                     const RegionMap& regions) {
  const Region* region = kind.region_of(fluent, regions);
  if (region == nullptr) return {};
  const auto point = kind.point_of(fluent, state, regions);
  if (!point) return {};
  if (auto text = hindrance(kind, *region, fluent, state); !text.empty()) return text;
  const auto body = with_arguments(kind.body, fluent);
  const auto in_frame =
      region->frame.empty() ? std::string() : fmt::format(" in the frame of {}", region->frame);
  // As a region reads it: an angle a turn away from the bounds is the same angle.
  const auto value_on = [&](RegionAxis axis) {
    const double value = (*point)[static_cast<std::size_t>(axis)];
    const auto& bounds = region->on(axis);
    return axis == RegionAxis::kYaw && bounds ? unwrapped(value, *bounds) : value;
  };
  // The axis that is farthest outside, or nearest to a border from inside, in widths.
  const RegionAxis* decides = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const RegionAxis& axis : kRegionAxes) {
    const auto& bounds = region->on(axis);
    if (!bounds) continue;
    const double value = value_on(axis);
    const double margin = std::min(value - bounds->lower, bounds->upper - value) / bounds->width();
    if (margin < least) decides = &axis, least = margin;
  }
  if (region->area && least >= 0.0) {
    const double inside_m = region->area->signed_distance_m({(*point)[0], (*point)[1]});
    return fmt::format("({0}.x, {0}.y) = ({1}, {2}) m{3}, {4} {5} {6}", body,
                       number_text((*point)[0]), number_text((*point)[1]), in_frame,
                       size_text(std::abs(inside_m), false),
                       inside_m < 0.0 ? "outside of" : "inside of", region->area->text());
  }
  if (decides == nullptr) return {};
  const bool is_in_rad = *decides == RegionAxis::kYaw;
  const double value = value_on(*decides);
  const auto place = place_in(*region->on(*decides), value, is_in_rad);
  return fmt::format("{}.{} = {} {}{}{} {}", body, to_string(*decides), number_text(value),
                     is_in_rad ? "rad" : "m", in_frame, place.starts_with("within") ? "" : ",",
                     place);
}

std::string measured(const FlagBinding& kind, const GroundFluent& fluent, const State& state,
                     const RegionMap& /*regions*/) {
  // In a world that is a model the variable is the fluent itself.
  const auto variable = with_arguments(kind.variable, fluent);
  return variable == fluent.text ? "" : assigned(variable, state);
}

std::string measured(const RangeBinding& kind, const GroundFluent& fluent, const State& state,
                     const RegionMap& /*regions*/) {
  const auto text = assigned(with_arguments(kind.variable, fluent), state);
  if (text.empty()) return {};
  return fmt::format("{}; it holds within {}, and fails within {}", text, bounds_text(kind.holds),
                     bounds_text(kind.fails));
}

std::string measured(const EqualsBinding& kind, const GroundFluent& fluent, const State& state,
                     const RegionMap& /*regions*/) {
  const auto text = assigned(with_arguments(kind.variable, fluent), state);
  if (text.empty()) return {};
  return fmt::format("{}; it holds for \"{}\"", text, with_arguments(kind.text, fluent));
}

std::string measured(const BorderBinding& kind, const GroundFluent& fluent, const State& state,
                     const RegionMap& /*regions*/) {
  const auto text = assigned(with_arguments(kind.variable, fluent), state);
  if (text.empty() || !kind.concerns(fluent)) return {};
  return fmt::format("{}; it holds {} {:.6g}", text, kind.above ? "above" : "up to", kind.border);
}

std::string measured(const IgnoredBinding& /*kind*/, const GroundFluent& /*fluent*/,
                     const State& /*state*/, const RegionMap& /*regions*/) {
  return {};
}

}  // namespace

std::string measured_text(const StateMapping& mapping, const GroundFluent& fluent,
                          const State& state) {
  const FluentBinding* binding = mapping.find(fluent.symbol);
  if (binding == nullptr) return {};
  return std::visit(
      [&](const auto& kind) { return measured(kind, fluent, state, mapping.regions()); },
      binding->condition);
}

}  // namespace parallax::harness
