#include "harness/region/state_mapping.h"

#include <fmt/core.h>

#include <algorithm>

namespace parallax::harness {
namespace {

const Value* look_up(const State& state, const std::string& variable,
                     std::set<std::string>* missing) {
  const auto found = state.find(variable);
  if (found != state.end()) return &found->second;
  if (missing != nullptr) missing->insert(variable);
  return nullptr;
}

std::optional<double> number(const State& state, const std::string& variable,
                             std::set<std::string>* missing) {
  const Value* value = look_up(state, variable, missing);
  if (value == nullptr) return std::nullopt;
  if (const auto* real = std::get_if<double>(value)) return *real;
  if (const auto* whole = std::get_if<std::int64_t>(value)) return static_cast<double>(*whole);
  if (missing != nullptr) missing->insert(variable);  // a word or a flag is no position
  return std::nullopt;
}

/// Adapters that know no booleans send 0 and 1.
std::optional<bool> flag(const State& state, const std::string& variable,
                         std::set<std::string>* missing) {
  const Value* value = look_up(state, variable, missing);
  if (value == nullptr) return std::nullopt;
  if (const auto* boolean = std::get_if<bool>(value)) return *boolean;
  if (const auto* whole = std::get_if<std::int64_t>(value)) return *whole != 0;
  if (missing != nullptr) missing->insert(variable);
  return std::nullopt;
}

bool holds_inside(const InsideBinding& binding, const GroundFluent& fluent, const State& state,
                  const RegionSet& regions, std::set<std::string>* missing) {
  const std::string body = with_arguments(binding.body, fluent);
  const Region* region = regions.find(fluent.arguments.at(binding.region_argument));
  PARALLAX_REQUIRE(region != nullptr, "the mapping was checked against the regions");
  std::array<double, 4> point{};
  bool complete = true;
  for (const Axis axis : kAxes) {
    if (!region->on(axis)) continue;
    const auto value = number(state, fmt::format("{}.{}", body, to_string(axis)), missing);
    complete = complete && value.has_value();
    point[static_cast<std::size_t>(axis)] = value.value_or(0.0);
  }
  const auto allowed = [&](const std::optional<std::string>& variable, bool wanted) {
    if (!variable) return true;
    return flag(state, with_arguments(*variable, fluent), missing) == wanted;
  };
  // Both are evaluated, so that every missing variable is named.
  const bool not_excluded = allowed(binding.unless, false);
  const bool enabled = allowed(binding.only_if, true);
  return complete && not_excluded && enabled && regions.locate(point) == region;
}

}  // namespace

GroundFluent ground_fluent(std::string_view text) {
  GroundFluent result{std::string(text), {}, {}};
  const auto open = text.find('(');
  result.symbol = text.substr(0, open);
  if (open == std::string_view::npos) return result;
  PARALLAX_REQUIRE(text.back() == ')', "a ground fluent ends with its last parenthesis");
  const auto inner = text.substr(open + 1, text.size() - open - 2);
  if (inner.empty()) return result;
  int depth = 0;
  result.arguments.emplace_back();
  for (const char c : inner) {
    if (c == '(') ++depth;
    if (c == ')') --depth;
    if (c == ',' && depth == 0) {
      result.arguments.emplace_back();
    } else {
      result.arguments.back().push_back(c);
    }
  }
  return result;
}

bool is_angle(std::string_view variable) { return variable.ends_with(".yaw"); }

std::string with_arguments(std::string_view pattern, const GroundFluent& fluent) {
  std::string result(pattern);
  for (std::size_t i = 0; i < fluent.arguments.size(); ++i) {
    const std::string place = fmt::format("{{{}}}", i);
    const auto& argument = fluent.arguments[i];
    for (auto at = result.find(place); at != std::string::npos;
         at = result.find(place, at + argument.size())) {
      result.replace(at, place.size(), argument);
    }
  }
  return result;
}

StateMapping::StateMapping(RegionSet regions, std::vector<FluentBinding> bindings)
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

std::optional<bool> StateMapping::holds(const GroundFluent& fluent, const State& state,
                                        std::set<std::string>* missing) const {
  const FluentBinding* binding = find(fluent.symbol);
  PARALLAX_REQUIRE(binding != nullptr, "the mapping was checked against the model's fluents");
  if (const auto* inside = std::get_if<InsideBinding>(&binding->condition)) {
    PARALLAX_REQUIRE(inside->region_argument < fluent.arguments.size(),
                     "the mapping was checked against the model's fluents");
    return holds_inside(*inside, fluent, state, regions_, missing);
  }
  if (const auto* flagged = std::get_if<FlagBinding>(&binding->condition)) {
    return flag(state, with_arguments(flagged->variable, fluent), missing).value_or(false);
  }
  return std::nullopt;
}

}  // namespace parallax::harness
