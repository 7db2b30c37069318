#include "harness/region/state_mapping.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/base/contract.h"

namespace parallax::harness {
bool is_angle(std::string_view variable) { return variable.ends_with(".yaw"); }

StateMapping::StateMapping(RegionMap regions, std::vector<FluentBinding> bindings)
    : regions_(std::move(regions)), bindings_(std::move(bindings)) {
  std::stable_sort(
      bindings_.begin(), bindings_.end(),
      [](const FluentBinding& a, const FluentBinding& b) { return a.fluent < b.fluent; });
}

const FluentBinding* StateMapping::find(std::string_view symbol) const {
  const auto found = std::lower_bound(
      bindings_.begin(), bindings_.end(), symbol,
      [](const FluentBinding& binding, std::string_view name) { return binding.fluent < name; });
  return found == bindings_.end() || found->fluent != symbol ? nullptr : &*found;
}

std::optional<Reading> StateMapping::read(const GroundFluent& fluent, const State& state,
                                          std::set<std::string>* missing) const {
  const FluentBinding* binding = find(fluent.symbol);
  PARALLAX_REQUIRE(binding != nullptr, "the mapping was checked against the model's fluents");
  return binding->read(fluent, state, regions_, missing);
}

std::optional<bool> StateMapping::holds(const GroundFluent& fluent, const State& state,
                                        std::set<std::string>* missing) const {
  const auto result = read(fluent, state, missing);
  if (!result) return std::nullopt;
  return *result == Reading::kHolds;
}

std::string StateMapping::outside_text(const GroundFluent& fluent) const {
  const FluentBinding* binding = find(fluent.symbol);
  const auto* inside = binding == nullptr ? nullptr : binding->inside();
  if (inside == nullptr) return {};
  std::vector<std::string> arguments = fluent.arguments;
  arguments.at(inside->region_argument) = "outside";
  return fmt::format("{}({})", fluent.symbol, fmt::join(arguments, ","));
}

std::vector<std::string> StateMapping::outside(const std::vector<GroundFluent>& fluents,
                                               const State& state) const {
  // By text: is the body in some region?
  std::map<std::string, bool> found;
  for (const GroundFluent& fluent : fluents) {
    const FluentBinding* binding = find(fluent.symbol);
    if (binding == nullptr) continue;
    const auto* inside = binding->inside();
    if (inside == nullptr || !inside->flags_allow(fluent, state, nullptr)) continue;
    const std::string text = outside_text(fluent);
    const auto reading = inside->read(fluent, state, regions_, nullptr);
    found[text] = found[text] || reading == Reading::kHolds;
  }
  std::vector<std::string> bodies;
  for (const auto& [text, in_some] : found) {
    if (!in_some) bodies.push_back(text);
  }
  return bodies;
}

}  // namespace parallax::harness
