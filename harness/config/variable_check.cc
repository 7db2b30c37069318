#include "harness/config/variable_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "compiler/base/codes/scenarios.h"
#include "harness/config/keys.h"

namespace parallax::harness {
namespace {

/// A number, by its unit; what has the unit 1 may be anything but for the built-in simulator, whose
/// other variables are flags, and texts where a robot looks.
enum class VariableKind : std::uint8_t { kUnknown, kNumber, kFlag, kText };
VariableKind kind_of(const Parameter& parameter, bool built_in) {
  for (const std::string_view unit : {"m", "rad", "kg", "s", "m/s", "rad/s", "N", "Nm"}) {
    if (parameter.unit == unit) return VariableKind::kNumber;
  }
  if (!built_in || parameter.unit != "1") return VariableKind::kUnknown;
  return parameter.name.ends_with(".looking_at") ? VariableKind::kText : VariableKind::kFlag;
}

std::string_view words_for(VariableKind kind) {
  return kind == VariableKind::kNumber ? "a number"
         : kind == VariableKind::kFlag ? "true or false"
                                       : "a text";
}

/// The variables that a fluent reads as something of one kind, by the key that names them.
struct KindUse {
  std::string_view key;
  std::string variable;
  VariableKind kind;
};
std::vector<KindUse> kind_uses(const FluentBinding& binding, const GroundFluent& fluent) {
  std::vector<KindUse> out;
  const auto add = [&](std::string_view key, const std::string& variable, VariableKind kind) {
    out.push_back({key, with_arguments(variable, fluent), kind});
  };
  if (const auto* inside = binding.inside()) {
    if (inside->unless) add(Key::kUnless, *inside->unless, VariableKind::kFlag);
    if (inside->only_if) add(Key::kOnlyIf, *inside->only_if, VariableKind::kFlag);
  } else if (const auto* flag = std::get_if<FlagBinding>(&binding.condition)) {
    add(Key::kFlag, flag->variable, VariableKind::kFlag);
  } else if (const auto* range = std::get_if<RangeBinding>(&binding.condition)) {
    add(Key::kRange, range->variable, VariableKind::kNumber);
  } else if (const auto* equals = std::get_if<EqualsBinding>(&binding.condition)) {
    add(Key::kEquals, equals->variable, VariableKind::kText);
  }
  return out;
}

}  // namespace

void check_kinds(const Scenario& scenario, const std::vector<GroundFluent>& fluents,
                 const std::vector<Parameter>& parameters, base::DiagnosticSink& sink) {
  const bool built_in = scenario.simulator.is_built_in();
  std::set<std::string> reported;
  for (const auto& fluent : fluents) {
    const auto* binding = scenario.mapping->find(fluent.symbol);
    if (binding == nullptr || reported.contains(fluent.symbol)) continue;
    for (const auto& use : kind_uses(*binding, fluent)) {
      const auto found =
          std::find_if(parameters.begin(), parameters.end(),
                       [&](const Parameter& one) { return one.name == use.variable; });
      if (found == parameters.end()) continue;
      const auto kind = kind_of(*found, built_in);
      if (kind == VariableKind::kUnknown || kind == use.kind) continue;
      if (!reported.insert(fluent.symbol).second) break;
      sink.error(codes::kBadWorld, binding->source,
                 fmt::format("mapping/{}/{}", fluent.symbol, use.key),
                 fmt::format("asks for {}, and `{}` is {}", words_for(use.kind), use.variable,
                             words_for(kind)));
    }
  }
}

void check_angle(const SampledDimension& dimension, const Parameter& parameter,
                 const Scenario& scenario, base::DiagnosticSink& sink) {
  constexpr double kTurn_rad = 2.0 * std::numbers::pi, kRounding_rad = 0.05;
  if (parameter.unit != "rad" && !is_angle(parameter.name)) return;
  const Interval& at = dimension.interval;
  const double farthest = std::max(std::abs(at.lower), std::abs(at.upper));
  const bool is_wide = at.upper - at.lower > kTurn_rad + kRounding_rad;
  if (!is_wide && farthest <= 2.0 * kTurn_rad) return;
  sink.error(
      codes::kBadWorld, scenario.sampled_at(dimension.variable),
      fmt::format("sampling/{}", dimension.variable),
      fmt::format("is from {:g} to {:g} rad, and {}; angles are in radians: {:g} degrees are "
                  "{:.4g} rad",
                  at.lower, at.upper, is_wide ? "a turn is 6.283 rad" : "that is turns away from 0",
                  at.upper, at.upper * std::numbers::pi / 180.0));
}

}  // namespace parallax::harness
