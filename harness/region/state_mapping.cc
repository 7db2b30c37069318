#include "harness/region/state_mapping.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

/// Takes a point of the world into the frame of a body, as far as the region bounds it.
void into_frame(const std::string& frame, const State& state, std::set<std::string>* missing,
                Point& point) {
  const auto at = [&](const char* item) {
    return number(state, fmt::format("{}.{}", frame, item), missing).value_or(0.0);
  };
  const double yaw = at("yaw");
  double& x = point[static_cast<std::size_t>(RegionAxis::kX)];
  double& y = point[static_cast<std::size_t>(RegionAxis::kY)];
  const double dx = x - at("x"), dy = y - at("y");
  x = std::cos(yaw) * dx + std::sin(yaw) * dy;
  y = std::cos(yaw) * dy - std::sin(yaw) * dx;
  point[static_cast<std::size_t>(RegionAxis::kYaw)] -= yaw;
  for (const RegionAxis axis : {RegionAxis::kZ, RegionAxis::kBottom}) {
    point[static_cast<std::size_t>(axis)] -= at("z");
  }
}

bool flags_allow(const InsideBinding& binding, const GroundFluent& fluent, const State& state,
                 std::set<std::string>* missing) {
  const auto allowed = [&](const std::optional<std::string>& variable, bool wanted) {
    if (!variable) return true;
    return flag(state, with_arguments(*variable, fluent), missing) == wanted;
  };
  // Both are evaluated, so that every missing variable is named.
  const bool not_excluded = allowed(binding.unless, false);
  const bool enabled = allowed(binding.only_if, true);
  return not_excluded && enabled;
}

bool holds_inside(const InsideBinding& binding, const GroundFluent& fluent, const State& state,
                  const RegionMap& regions, std::set<std::string>* missing) {
  const std::string body = with_arguments(binding.body, fluent);
  const Region* region = regions.find(fluent.arguments.at(binding.region_argument));
  PARALLAX_REQUIRE(region != nullptr, "the mapping was checked against the regions");
  Point point{};
  bool complete = true;
  for (const RegionAxis axis : kRegionAxes) {
    // A point in a turned frame takes both x and y.
    const bool needed =
        region->on(axis).has_value() ||
        (!region->frame.empty() && (axis == RegionAxis::kX || axis == RegionAxis::kY));
    if (!needed) continue;
    const auto value = number(state, fmt::format("{}.{}", body, to_string(axis)), missing);
    complete = complete && value.has_value();
    point[static_cast<std::size_t>(axis)] = value.value_or(0.0);
  }
  if (!region->frame.empty()) into_frame(region->frame, state, missing, point);
  return flags_allow(binding, fluent, state, missing) && complete &&
         regions.contains(*region, point);
}

Reading read_range(const RangeBinding& binding, const GroundFluent& fluent, const State& state,
                   std::set<std::string>* missing) {
  const auto value = number(state, with_arguments(binding.variable, fluent), missing);
  if (!value) return Reading::kFails;
  const auto within = [&](const Interval& i) { return *value >= i.lower && *value <= i.upper; };
  if (within(binding.holds)) return Reading::kHolds;
  return within(binding.fails) ? Reading::kFails : Reading::kNeither;
}

bool equals(const EqualsBinding& binding, const GroundFluent& fluent, const State& state,
            std::set<std::string>* missing) {
  const std::string variable = with_arguments(binding.variable, fluent);
  const Value* value = look_up(state, variable, missing);
  if (value == nullptr) return false;
  if (const auto* text = std::get_if<std::string>(value)) {
    return *text == with_arguments(binding.text, fluent);
  }
  if (missing != nullptr) missing->insert(variable);
  return false;
}

Reading reading(bool holds) { return holds ? Reading::kHolds : Reading::kFails; }

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
  if (const auto* inside = std::get_if<InsideBinding>(&binding->condition)) {
    PARALLAX_REQUIRE(inside->region_argument < fluent.arguments.size(),
                     "the mapping was checked against the model's fluents");
    return reading(holds_inside(*inside, fluent, state, regions_, missing));
  }
  if (const auto* flagged = std::get_if<FlagBinding>(&binding->condition)) {
    return reading(flag(state, with_arguments(flagged->variable, fluent), missing).value_or(false));
  }
  if (const auto* range = std::get_if<RangeBinding>(&binding->condition)) {
    return read_range(*range, fluent, state, missing);
  }
  if (const auto* equal = std::get_if<EqualsBinding>(&binding->condition)) {
    return reading(equals(*equal, fluent, state, missing));
  }
  return std::nullopt;
}

std::optional<bool> StateMapping::holds(const GroundFluent& fluent, const State& state,
                                        std::set<std::string>* missing) const {
  const auto result = read(fluent, state, missing);
  if (!result) return std::nullopt;
  return *result == Reading::kHolds;
}

std::string StateMapping::outside_text(const GroundFluent& fluent) const {
  const FluentBinding* binding = find(fluent.symbol);
  const auto* inside =
      binding == nullptr ? nullptr : std::get_if<InsideBinding>(&binding->condition);
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
    const auto* inside = std::get_if<InsideBinding>(&binding->condition);
    if (inside == nullptr || !flags_allow(*inside, fluent, state, nullptr)) continue;
    const std::string text = outside_text(fluent);
    found[text] = found[text] || holds_inside(*inside, fluent, state, regions_, nullptr);
  }
  std::vector<std::string> bodies;
  for (const auto& [text, in_some] : found) {
    if (!in_some) bodies.push_back(text);
  }
  return bodies;
}

}  // namespace parallax::harness
