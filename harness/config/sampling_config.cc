#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "compiler/base/codes/scenarios.h"
#include "harness/config/sections.h"
#include "harness/world/density.h"
#include "harness/world/structure_check.h"

namespace parallax::harness {
namespace {

/// A mass that is drawn, at both ends.
void warn_of_density(const WorldSpec& world, const YamlEntry& entry, const Interval& masses,
                     base::DiagnosticSink& sink) {
  constexpr std::string_view kMass = ".mass";
  if (!entry.key.ends_with(kMass)) return;
  const auto name = entry.key.substr(0, entry.key.size() - kMass.size());
  for (const BodySpec& body : world.bodies) {
    if (body.name != name || body.shapes.empty()) continue;
    for (const double mass_kg : {masses.lower, masses.upper}) {
      const auto odd = odd_density(body, mass_kg);
      if (!odd) continue;
      sink.warning(codes::kOddDensity, entry.value.range, fmt::format("{:g} kg", mass_kg),
                   fmt::format("`{}` a thing", name), density_kg_m3(body, mass_kg), *odd);
      return;
    }
  }
}

/// A mass that the built-in simulator can have.
void check_mass(const YamlEntry& entry, const Interval& masses, base::DiagnosticSink& sink) {
  if (!entry.key.ends_with(".mass")) return;
  if (masses.lower > 0.0 && masses.upper <= kMaxMass_kg) return;
  sink.error(codes::kYamlOutOfBounds, entry.value.range, fmt::format("`{}`", entry.key),
             fmt::format("from {} to {} kg", masses.lower, masses.upper),
             fmt::format("above 0 and at most {:g} kg", kMaxMass_kg));
}

/// One entry of `variables`.
void read_sampled_variable(const YamlEntry& entry, Scenario& scenario, base::DiagnosticSink& sink) {
  auto value = read_sampled_value(entry, sink);
  if (!value) return;
  scenario.sampled_sources[entry.key] = entry.key_range;
  const bool built_in = scenario.simulator.is_built_in();
  if (value->formula) {
    auto within = value->within;
    if (built_in && entry.key.ends_with(".mass") && !within) {
      within = Interval{std::numeric_limits<double>::min(), kMaxMass_kg, true};
    } else if (built_in && within) {
      check_mass(entry, *within, sink);
    }
    if (value->within) {
      // A dimension like the others, though it is not drawn: fluents and borders may narrow it.
      scenario.sampling.push_back({entry.key, *value->within});
      within.reset();
    }
    scenario.law.formulas.push_back(
        {entry.key, *std::move(value->formula), within, false, entry.key_range});
    return;
  }
  if (built_in) check_mass(entry, value->interval, sink);
  if (built_in) warn_of_density(scenario.world, entry, value->interval, sink);
  scenario.sampling.push_back({entry.key, value->interval});
  if (value->law) {
    scenario.law.marginals.push_back({entry.key, *std::move(value->law), entry.key_range});
  }
}

}  // namespace

void read_sampling(const YamlNode& node, Scenario& scenario, base::DiagnosticSink& sink) {
  YamlFields fields(node, key_text(Key::kSampling), sink);
  fields.may_be_absent();
  fields.only({Key::kInsetM, Key::kVariables, Key::kParameters, Key::kAreas, Key::kRequire});
  fields.number(Key::kInsetM, kNotNegative, scenario.sampling_inset_m);
  if (const auto* variables = fields.find(Key::kVariables)) {
    const YamlFields all(*variables, key_text(Key::kVariables), sink);
    all.may_be_absent();
    for (const auto& entry : variables->entries) read_sampled_variable(entry, scenario, sink);
  }
  if (const auto* parameters = fields.find(Key::kParameters)) {
    for (const auto& entry : parameters->entries) {
      scenario.sampled_sources.emplace(entry.key, entry.key_range);
    }
  }
  read_law(fields, scenario.world, scenario.law, sink);
  std::sort(scenario.sampling.begin(), scenario.sampling.end(),
            [](const auto& a, const auto& b) { return a.variable < b.variable; });
}

}  // namespace parallax::harness
