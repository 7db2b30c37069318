#include "harness/config/variable_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>

#include "compiler/base/codes/scenarios.h"
#include "harness/config/keys.h"
#include "harness/region/angle_range.h"
#include "harness/simulator/units.h"

namespace parallax::harness {
namespace {

enum class VariableKind : std::uint8_t { kUnknown, kNumber, kFlag, kText };

/// The type of a variable by its unit. What has the unit 1 may be anything, but for the built-in
/// simulator, where it is a flag, or a text where a robot looks.
VariableKind kind_of(const Parameter& parameter, bool built_in) {
  if (is_unit_of_numbers(parameter.unit)) return VariableKind::kNumber;
  if (!built_in || parameter.unit != "1") return VariableKind::kUnknown;
  return parameter.name.ends_with(".looking_at") ? VariableKind::kText : VariableKind::kFlag;
}

std::string_view words_for(VariableKind kind) {
  return kind == VariableKind::kNumber ? "a number"
         : kind == VariableKind::kFlag ? "true or false"
                                       : "a text";
}

/// A variable that a fluent reads as something of one kind, by the key that names it.
struct KindUse {
  std::string_view key;
  std::string variable;
  VariableKind kind;
};
std::vector<KindUse> kind_uses(const FluentBinding& binding, const GroundFluent& fluent,
                               const RegionMap& regions) {
  std::vector<KindUse> out;
  const auto add = [&](std::string_view key, const std::string& variable, VariableKind kind) {
    out.push_back({key, with_arguments(variable, fluent), kind});
  };
  if (const auto* inside = binding.inside()) {
    if (inside->unless) add(Key::kUnless, *inside->unless, VariableKind::kFlag);
    if (inside->only_if) add(Key::kOnlyIf, *inside->only_if, VariableKind::kFlag);
    // Its other variables are places, and how upright the body is.
    for (const auto& variable : binding.variables(fluent, regions)) {
      const bool is_flag = std::any_of(
          out.begin(), out.end(), [&](const KindUse& one) { return one.variable == variable; });
      if (!is_flag) out.push_back({Key::kInside, variable, VariableKind::kNumber});
    }
  } else if (const auto* flag = std::get_if<FlagBinding>(&binding.condition)) {
    add(Key::kFlag, flag->variable, VariableKind::kFlag);
  } else if (const auto* range = std::get_if<RangeBinding>(&binding.condition)) {
    add(Key::kRange, range->variable, VariableKind::kNumber);
  } else if (const auto* equals = std::get_if<EqualsBinding>(&binding.condition)) {
    add(Key::kEquals, equals->variable, VariableKind::kText);
  } else if (const auto* border = std::get_if<BorderBinding>(&binding.condition)) {
    if (border->concerns(fluent)) add(Key::kStart, border->variable, VariableKind::kNumber);
  }
  return out;
}

/// An interval or a number of a fluent's mapping that is about an angle, by its key.
struct AngleUse {
  std::string_view key;
  Interval angles_rad;
};
std::vector<AngleUse> angle_uses(const FluentBinding& binding) {
  const auto one = [](double angle_rad) { return Interval{angle_rad, angle_rad, true}; };
  if (const auto* range = std::get_if<RangeBinding>(&binding.condition)) {
    return {{Key::kHolds, range->holds},
            {Key::kFails, range->fails},
            {Key::kAtStart, one(range->at_start)}};
  }
  if (const auto* border = std::get_if<BorderBinding>(&binding.condition)) {
    return {{border->above ? Key::kAbove : Key::kUpTo, one(border->border)}};
  }
  return {};
}

bool is_in_radians(const Parameter& parameter) {
  return parameter.unit == "rad" || is_angle(parameter.name);
}

const Parameter* find(const std::vector<Parameter>& parameters, const std::string& name) {
  const auto found = std::find_if(parameters.begin(), parameters.end(),
                                  [&](const Parameter& one) { return one.name == name; });
  return found == parameters.end() ? nullptr : &*found;
}

}  // namespace

void check_kinds(const Scenario& scenario, const std::vector<GroundFluent>& fluents,
                 const std::vector<Parameter>& parameters, base::DiagnosticSink& sink) {
  const bool built_in = scenario.simulator.is_built_in();
  std::set<std::string> reported;
  const auto report = [&](const FluentBinding& binding, std::string_view key,
                          const std::string& fault) {
    if (!reported.insert(binding.fluent).second) return;
    sink.error(codes::kBadWorld, binding.source, fmt::format("mapping/{}/{}", binding.fluent, key),
               fault);
  };
  for (const auto& fluent : fluents) {
    const auto* binding = scenario.mapping->find(fluent.symbol);
    if (binding == nullptr || reported.contains(fluent.symbol)) continue;
    for (const auto& use : kind_uses(*binding, fluent, scenario.mapping->regions())) {
      const auto* found = find(parameters, use.variable);
      if (found == nullptr) continue;
      const auto kind = kind_of(*found, built_in);
      if (kind != VariableKind::kUnknown && kind != use.kind) {
        report(*binding, use.key,
               fmt::format("asks for {}, and `{}` is {}", words_for(use.kind), use.variable,
                           words_for(kind)));
      }
      if (!is_in_radians(*found)) continue;
      for (const auto& angle : angle_uses(*binding)) {
        if (const auto fault = angle_fault(angle.angles_rad)) report(*binding, angle.key, *fault);
      }
    }
  }
}

void check_law_kinds(const Scenario& scenario, const std::vector<Parameter>& parameters,
                     base::DiagnosticSink& sink) {
  const bool built_in = scenario.simulator.is_built_in();
  const auto check = [&](const Expression& expression) {
    for (const auto& name : expression.names()) {
      const auto* found = find(parameters, name.text);
      if (found == nullptr) continue;
      const auto kind = kind_of(*found, built_in);
      if (kind == VariableKind::kUnknown || kind == VariableKind::kNumber) continue;
      sink.error(codes::kBadWorld, name.source, fmt::format("sampling/{}", name.text),
                 fmt::format("is {}, and formulas compute with numbers", words_for(kind)));
    }
  };
  for (const auto& formula : scenario.law.formulas) check(formula.value);
  for (const auto& wanted : scenario.law.requirements) check(wanted.condition);
}

void check_angle(const SampledDimension& dimension, const Parameter& parameter,
                 const Scenario& scenario, base::DiagnosticSink& sink) {
  if (!is_in_radians(parameter)) return;
  Interval angles_rad = dimension.interval;
  for (const auto& marginal : scenario.law.marginals) {
    const auto& law = marginal.law;
    if (marginal.variable != dimension.variable || law.kind != Distribution::Kind::kNormal) {
      continue;
    }
    angles_rad.lower = std::max(angles_rad.lower, law.mean - law.sd);
    angles_rad.upper = std::min(angles_rad.upper, law.mean + law.sd);
    if (angles_rad.lower > angles_rad.upper) angles_rad = dimension.interval;  // a tail
  }
  const auto fault = angle_fault(angles_rad);
  if (!fault) return;
  sink.error(codes::kBadWorld, scenario.sampled_at(dimension.variable),
             fmt::format("sampling/{}", dimension.variable), *fault);
}

}  // namespace parallax::harness
