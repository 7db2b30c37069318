#include "harness/region/fluent_binding.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "compiler/base/contract.h"
#include "harness/region/area.h"
#include "harness/region/fluent_margin.h"

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
  // Drawn values are numbers.
  if (const auto* real = std::get_if<double>(value);
      real != nullptr && (*real == 0 || *real == 1)) {
    return *real == 1;
  }
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

Reading reading(bool holds) { return holds ? Reading::kHolds : Reading::kFails; }

/// A flag that has to be true at a reset, which puts every flag down.
std::string needs_flag(const std::string& pattern, const GroundFluent& fluent) {
  return fmt::format("`{}` holds, but a reset cannot make `{}` true", fluent.text,
                     with_arguments(pattern, fluent));
}

/// Leans the body no more than the binding allows?
bool is_upright(const InsideBinding& kind, const Region& region, const std::string& body,
                const State& state, std::set<std::string>* missing) {
  const auto& free = kind.upright_except;
  if (!kind.upright || std::find(free.begin(), free.end(), region.name) != free.end()) return true;
  const auto roll = number(state, body + ".roll", missing);
  const auto pitch = number(state, body + ".pitch", missing);
  // The cosine of the angle between the two verticals.
  return roll && pitch && std::cos(*roll) * std::cos(*pitch) >= std::cos(*kind.upright);
}

// Answers of each kind of condition about a ground fluent of its symbol. FluentBinding, which
// declares the questions, passes each of them on to its kind.

/// Where the body is, in the region's frame; false: the state does not say all that is asked for.
bool find_body(const Region& region, const std::string& name, const State& state,
               std::set<std::string>* missing, Point& point) {
  bool complete = true;
  for (const RegionAxis axis : kRegionAxes) {
    // A point in a turned frame takes both x and y.
    const bool needed =
        region.on(axis).has_value() ||
        (!region.frame.empty() && (axis == RegionAxis::kX || axis == RegionAxis::kY));
    if (!needed) continue;
    const auto value = number(state, fmt::format("{}.{}", name, to_string(axis)), missing);
    complete = complete && value.has_value();
    point[static_cast<std::size_t>(axis)] = value.value_or(0.0);
  }
  if (!region.frame.empty()) into_frame(region.frame, state, missing, point);
  return complete;
}

/// Signed distance from the ends, in widths.
double margin_in(const Interval& interval, double value) {
  return std::min(value - interval.lower, interval.upper - value) / interval.width();
}

/// The margin of a body that is expected in the region; none: a flag or a missing variable decides.
std::optional<double> margin_of(const InsideBinding& kind, const GroundFluent& fluent,
                                const State& state, const RegionMap& regions) {
  const Region* region = kind.region_of(fluent, regions);
  const std::string name = with_arguments(kind.body, fluent);
  const auto found = kind.point_of(fluent, state, regions);
  if (!found) return std::nullopt;
  const Point& point = *found;
  if (!kind.flags_allow(fluent, state, nullptr)) return std::nullopt;
  double least = std::numeric_limits<double>::infinity();
  for (const RegionAxis axis : kRegionAxes) {
    const auto& bounds = region->on(axis);
    if (bounds) least = std::min(least, margin_in(*bounds, point[static_cast<std::size_t>(axis)]));
  }
  if (region->area) {
    const auto [lower, upper] = region->area->bounds();
    const double width_m = std::min(upper[0] - lower[0], upper[1] - lower[1]);
    least = std::min(least, region->area->signed_distance_m({point[0], point[1]}) / width_m);
  }
  const auto& free = kind.upright_except;
  if (kind.upright && std::find(free.begin(), free.end(), region->name) == free.end()) {
    const auto roll = number(state, name + ".roll", nullptr);
    const auto pitch = number(state, name + ".pitch", nullptr);
    if (!roll || !pitch) return std::nullopt;
    const double upright = std::clamp(std::cos(*roll) * std::cos(*pitch), -1.0, 1.0);
    least = std::min(least, (*kind.upright - std::acos(upright)) / *kind.upright);
  }
  if (!std::isfinite(least)) return std::nullopt;
  return least;
}

std::optional<Reading> read(const InsideBinding& kind, const GroundFluent& fluent,
                            const State& state, const RegionMap& regions,
                            std::set<std::string>* missing) {
  const Region* region = kind.region_of(fluent, regions);
  PARALLAX_REQUIRE(region != nullptr, "the mapping was checked against the regions");
  const std::string name = with_arguments(kind.body, fluent);
  Point point{};
  bool complete = find_body(*region, name, state, missing, point);
  complete = is_upright(kind, *region, name, state, missing) && complete;
  return reading(kind.flags_allow(fluent, state, missing) && complete &&
                 regions.contains(*region, point));
}

std::optional<Reading> read(const FlagBinding& kind, const GroundFluent& fluent, const State& state,
                            const RegionMap& /*regions*/, std::set<std::string>* missing) {
  return reading(flag(state, with_arguments(kind.variable, fluent), missing).value_or(false));
}

std::optional<Reading> read(const RangeBinding& kind, const GroundFluent& fluent,
                            const State& state, const RegionMap& /*regions*/,
                            std::set<std::string>* missing) {
  const auto value = number(state, with_arguments(kind.variable, fluent), missing);
  if (!value) return Reading::kFails;
  const auto within = [&](const Interval& i) { return *value >= i.lower && *value <= i.upper; };
  if (within(kind.holds)) return Reading::kHolds;
  return within(kind.fails) ? Reading::kFails : Reading::kNeither;
}

std::optional<Reading> read(const EqualsBinding& kind, const GroundFluent& fluent,
                            const State& state, const RegionMap& /*regions*/,
                            std::set<std::string>* missing) {
  const std::string name = with_arguments(kind.variable, fluent);
  const Value* value = look_up(state, name, missing);
  if (value == nullptr) return Reading::kFails;
  if (const auto* word = std::get_if<std::string>(value)) {
    return reading(*word == with_arguments(kind.text, fluent));
  }
  if (missing != nullptr) missing->insert(name);
  return Reading::kFails;
}

std::optional<Reading> read(const BorderBinding& kind, const GroundFluent& fluent,
                            const State& state, const RegionMap& /*regions*/,
                            std::set<std::string>* missing) {
  if (!kind.concerns(fluent)) return Reading::kFails;
  const auto value = number(state, with_arguments(kind.variable, fluent), missing);
  return reading(value && (*value > kind.border) == kind.above);
}

std::optional<Reading> read(const IgnoredBinding&, const GroundFluent&, const State&,
                            const RegionMap&, std::set<std::string>*) {
  return std::nullopt;
}

/// The variable of kinds that are about one variable.
template <typename Kind>
std::vector<std::string> variables(const Kind& kind, const GroundFluent& fluent,
                                   const RegionMap& /*regions*/) {
  return {with_arguments(kind.variable, fluent)};
}

std::vector<std::string> variables(const InsideBinding& kind, const GroundFluent& fluent,
                                   const RegionMap& regions) {
  std::vector<std::string> out;
  const Region* region = kind.region_of(fluent, regions);
  for (const RegionAxis axis : kRegionAxes) {
    if (region == nullptr || !region->on(axis)) continue;
    out.push_back(fmt::format("{}.{}", with_arguments(kind.body, fluent), to_string(axis)));
  }
  for (const auto& variable : {kind.unless, kind.only_if}) {
    if (variable) out.push_back(with_arguments(*variable, fluent));
  }
  if (kind.upright) {
    const std::string body = with_arguments(kind.body, fluent);
    out.insert(out.end(), {body + ".roll", body + ".pitch"});
  }
  return out;
}

std::vector<std::string> variables(const BorderBinding& kind, const GroundFluent& fluent,
                                   const RegionMap& /*regions*/) {
  if (!kind.concerns(fluent)) return {};
  return {with_arguments(kind.variable, fluent)};
}

std::vector<std::string> variables(const IgnoredBinding&, const GroundFluent&, const RegionMap&) {
  return {};
}

/// Those that every fluent of the symbol is read from, as patterns.
template <typename Kind>
std::vector<std::string> constant_variables(const Kind& kind, const RegionMap& /*regions*/) {
  return {kind.variable};
}

std::vector<std::string> constant_variables(const InsideBinding& kind, const RegionMap& regions) {
  std::vector<std::string> out;
  const auto& all = regions.regions();
  for (const RegionAxis axis : kRegionAxes) {
    const bool bounded = !all.empty() && std::all_of(all.begin(), all.end(), [&](const Region& r) {
      return r.on(axis).has_value();
    });
    if (bounded) out.push_back(fmt::format("{}.{}", kind.body, to_string(axis)));
  }
  if (kind.upright) out.insert(out.end(), {kind.body + ".roll", kind.body + ".pitch"});
  if (kind.unless) out.push_back(*kind.unless);
  if (kind.only_if) out.push_back(*kind.only_if);
  return out;
}

std::vector<std::string> constant_variables(const IgnoredBinding&, const RegionMap&) { return {}; }

std::optional<std::string> reset_conflict(const InsideBinding& kind, const GroundFluent& fluent,
                                          bool wanted) {
  if (!wanted || !kind.only_if) return std::nullopt;
  return needs_flag(*kind.only_if, fluent);
}

std::optional<std::string> reset_conflict(const FlagBinding& kind, const GroundFluent& fluent,
                                          bool wanted) {
  if (kind.drawn.value_or(false) || wanted == kind.at_start) return std::nullopt;
  if (wanted) return needs_flag(kind.variable, fluent);
  return fmt::format("`{}` does not hold, but a reset makes `{}` true", fluent.text,
                     with_arguments(kind.variable, fluent));
}

std::optional<std::string> reset_conflict(const RangeBinding& kind, const GroundFluent& fluent,
                                          bool wanted) {
  const auto& interval = wanted ? kind.holds : kind.fails;
  if (kind.at_start >= interval.lower && kind.at_start <= interval.upper) return std::nullopt;
  return fmt::format("`{}` {}, but a reset makes `{}` {}", fluent.text,
                     wanted ? "holds" : "does not hold", with_arguments(kind.variable, fluent),
                     kind.at_start);
}

std::optional<std::string> reset_conflict(const EqualsBinding& kind, const GroundFluent& fluent,
                                          bool wanted) {
  if (!wanted) return std::nullopt;
  return needs_flag(kind.variable, fluent);
}

std::optional<std::string> reset_conflict(const BorderBinding& kind, const GroundFluent& fluent,
                                          bool wanted) {
  if (!wanted || kind.concerns(fluent)) return std::nullopt;
  return fmt::format("`{}` holds, but it can only for {}", fluent.text, fmt::join(kind.only, ", "));
}

std::optional<std::string> reset_conflict(const IgnoredBinding&, const GroundFluent&, bool) {
  return std::nullopt;
}

/// Adds the reset value of kinds whose variable has a value of its own after a reset.
template <typename Kind>
void add_reset_values(const Kind& kind, const GroundFluent& fluent, const RegionMap& /*regions*/,
                      State& state) {
  state.emplace(with_arguments(kind.variable, fluent), kind.at_start);
}

void add_reset_values(const InsideBinding& kind, const GroundFluent& fluent,
                      const RegionMap& regions, State& state) {
  for (const auto& variable : {kind.unless, kind.only_if}) {
    if (variable) state.emplace(with_arguments(*variable, fluent), false);
  }
  if (kind.upright) {
    const std::string body = with_arguments(kind.body, fluent);
    for (const char* item : {".roll", ".pitch"}) state.emplace(body + item, 0.0);
  }
  const Region* region = kind.region_of(fluent, regions);
  if (!kind.drawn || region == nullptr || region->frame.empty()) return;
  static constexpr std::array<const char*, 3> kItems = {".x", ".y", ".z"};
  for (std::size_t i = 0; i < kItems.size(); ++i) {
    state.emplace(region->frame + kItems[i], region->frame_start[i]);
  }
  state.emplace(region->frame + ".yaw", 0.0);
}

void add_reset_values(const EqualsBinding& kind, const GroundFluent& fluent,
                      const RegionMap& /*regions*/, State& state) {
  state.emplace(with_arguments(kind.variable, fluent), std::string());
}

void add_reset_values(const BorderBinding&, const GroundFluent&, const RegionMap&, State&) {}

void add_reset_values(const IgnoredBinding&, const GroundFluent&, const RegionMap&, State&) {}

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

bool BorderBinding::concerns(const GroundFluent& fluent) const {
  if (only.empty()) return true;
  return !fluent.arguments.empty() &&
         std::find(only.begin(), only.end(), fluent.arguments.front()) != only.end();
}

Interval BorderBinding::side(bool wanted) const {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  return wanted == above ? Interval{border, kFar} : Interval{-kFar, border};
}

const Region* InsideBinding::region_of(const GroundFluent& fluent, const RegionMap& regions) const {
  return region_argument < fluent.arguments.size() ? regions.find(fluent.arguments[region_argument])
                                                   : nullptr;
}

std::optional<Point> InsideBinding::point_of(const GroundFluent& fluent, const State& state,
                                             const RegionMap& regions) const {
  const Region* region = region_of(fluent, regions);
  Point point{};
  if (region == nullptr ||
      !find_body(*region, with_arguments(body, fluent), state, nullptr, point)) {
    return std::nullopt;
  }
  return point;
}

bool InsideBinding::flags_allow(const GroundFluent& fluent, const State& state,
                                std::set<std::string>* missing) const {
  const auto allowed = [&](const std::optional<std::string>& variable, bool wanted) {
    if (!variable) return true;
    return flag(state, with_arguments(*variable, fluent), missing) == wanted;
  };
  // Both are evaluated, so that every missing variable is named.
  const bool not_excluded = allowed(unless, false);
  const bool enabled = allowed(only_if, true);
  return not_excluded && enabled;
}

std::optional<Reading> FluentBinding::read(const GroundFluent& ground, const State& state,
                                           const RegionMap& regions,
                                           std::set<std::string>* missing) const {
  return std::visit(
      [&](const auto& kind) { return harness::read(kind, ground, state, regions, missing); },
      condition);
}

std::vector<std::string> FluentBinding::variables(const GroundFluent& ground,
                                                  const RegionMap& regions) const {
  return std::visit([&](const auto& kind) { return harness::variables(kind, ground, regions); },
                    condition);
}

std::vector<std::string> FluentBinding::constant_variables(const RegionMap& regions) const {
  auto out = std::visit(
      [&](const auto& kind) { return harness::constant_variables(kind, regions); }, condition);
  std::erase_if(out, [](const std::string& v) { return v.find('{') != std::string::npos; });
  return out;
}

std::optional<std::string> FluentBinding::reset_conflict(const GroundFluent& ground,
                                                         bool wanted) const {
  return std::visit([&](const auto& kind) { return harness::reset_conflict(kind, ground, wanted); },
                    condition);
}

void FluentBinding::add_reset_values(const GroundFluent& ground, const RegionMap& regions,
                                     State& state) const {
  std::visit([&](const auto& kind) { harness::add_reset_values(kind, ground, regions, state); },
             condition);
}

std::optional<double> fluent_margin(const StateMapping& mapping, const GroundFluent& fluent,
                                    bool predicted, const State& state) {
  const auto* binding = mapping.find(fluent.symbol);
  if (binding == nullptr) return std::nullopt;
  if (const auto* inside = binding->inside()) {
    return predicted ? margin_of(*inside, fluent, state, mapping.regions()) : std::nullopt;
  }
  const auto* range = std::get_if<RangeBinding>(&binding->condition);
  if (range == nullptr) return std::nullopt;
  const auto value = number(state, with_arguments(range->variable, fluent), nullptr);
  const auto& cell = predicted ? range->holds : range->fails;
  if (!value || !(cell.width() > 0.0)) return std::nullopt;
  return margin_in(cell, *value);
}

}  // namespace parallax::harness
