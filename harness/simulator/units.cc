#include "harness/simulator/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>

namespace parallax::harness {
namespace {

constexpr double kLongest_m = 1e4;
// Joints turn more than once, but not so that nobody winds them back.
constexpr double kMostTurn_rad = 2.0 * std::numbers::pi;

constexpr std::array<std::string_view, 20> kUnits = {"",  "1",  "m",   "rad", "s",     "kg",    "N",
                                                     "n", "Nm", "m/s", "nm",  "m/s^2", "rad/s", "J",
                                                     "W", "Hz", "Pa",  "K",   "V",     "A"};

/// Units that people write where SI is asked for, and what belongs there.
constexpr std::array<std::array<std::string_view, 2>, 12> kForeign = {{{"deg", "rad"},
                                                                       {"degree", "rad"},
                                                                       {"degrees", "rad"},
                                                                       {"mm", "m"},
                                                                       {"cm", "m"},
                                                                       {"km", "m"},
                                                                       {"inch", "m"},
                                                                       {"ft", "m"},
                                                                       {"ms", "s"},
                                                                       {"g", "kg"},
                                                                       {"km/h", "m/s"},
                                                                       {"deg/s", "rad/s"}}};

/// How the last part of a name ends, and the unit that this says.
constexpr std::array<std::array<std::string_view, 2>, 21> kEndings = {
    {{".x", "m"},        {".y", "m"},       {".z", "m"},         {".bottom", "m"},  {"_m", "m"},
     {".roll", "rad"},   {".pitch", "rad"}, {".yaw", "rad"},     {".angle", "rad"}, {"_rad", "rad"},
     {".mass", "kg"},    {"_kg", "kg"},     {"_s", "s"},         {"_n", "N"},       {"_m_s", "m/s"},
     {"_m_s2", "m/s^2"}, {"_nm", "Nm"},     {"_rad_s", "rad/s"}, {".radius", "m"},  {".width", "m"},
     {".height", "m"}}};

bool same_unit(std::string_view a, std::string_view b) {
  const auto folded = [](std::string_view unit) {
    return unit == "n" ? std::string_view("N") : unit == "nm" ? std::string_view("Nm") : unit;
  };
  return folded(a) == folded(b);
}

/// The longest ending counts: `_m_s` before `_s`.
std::string_view unit_by_name(std::string_view name) {
  std::string_view best_ending, best;
  for (const auto& [ending, unit] : kEndings) {
    if (name.ends_with(ending) && ending.size() > best_ending.size()) {
      best_ending = ending;
      best = unit;
    }
  }
  return best;
}

/// Checks the unit that is named for a variable. Returns nothing if it is right.
std::optional<UnitFinding> wrong_unit(const std::string& name, const std::string& unit) {
  for (const auto& [foreign, right] : kForeign) {
    if (unit == foreign) {
      return UnitFinding{
          true, fmt::format("`{}` is in `{}`; the protocol has `{}` alone", name, foreign, right)};
    }
  }
  if (std::find(kUnits.begin(), kUnits.end(), unit) == kUnits.end()) {
    return UnitFinding{
        false, fmt::format("`{}` is in `{}`, which is no unit that is known here", name, unit)};
  }
  const auto meant = unit_by_name(name);
  if (meant.empty() || unit.empty() || unit == "1" || same_unit(meant, unit)) return std::nullopt;
  return UnitFinding{true, fmt::format("`{}` is called like something in `{}`, and said to be in "
                                       "`{}`",
                                       name, meant, unit)};
}

std::optional<double> greatest(const std::string& name, const std::vector<State>& seen) {
  std::optional<double> most;
  for (const auto& state : seen) {
    const auto found = state.find(name);
    if (found == state.end()) continue;
    double value = 0.0;
    if (const auto* number = std::get_if<double>(&found->second)) value = *number;
    if (const auto* number = std::get_if<std::int64_t>(&found->second)) {
      value = static_cast<double>(*number);
    }
    most = std::max(most.value_or(0.0), std::abs(value));
  }
  return most;
}

}  // namespace

bool is_unit_of_numbers(std::string_view unit) {
  return !unit.empty() && unit != "1" &&
         std::find(kUnits.begin(), kUnits.end(), unit) != kUnits.end();
}

std::vector<UnitFinding> unit_findings(const SimulatorInfo& info, const std::vector<State>& seen) {
  std::vector<UnitFinding> findings;
  for (const auto& parameter : info.parameters) {
    if (auto wrong = wrong_unit(parameter.name, parameter.unit)) {
      findings.push_back(*std::move(wrong));
    }
    const auto unit = parameter.unit.empty() || parameter.unit == "1"
                          ? unit_by_name(parameter.name)
                          : std::string_view(parameter.unit);
    const auto most = greatest(parameter.name, seen);
    if (!most) continue;
    if (unit == "rad" && *most > kMostTurn_rad + 1e-6) {
      findings.push_back({true, fmt::format("`{}` is an angle of {:g} rad, more than a full turn: "
                                            "are these degrees?",
                                            parameter.name, *most)});
    }
    if (unit == "m" && *most > kLongest_m) {
      findings.push_back(
          {true, fmt::format("`{}` is {:g} m: are these millimetres?", parameter.name, *most)});
    }
  }
  for (const auto& [action, arguments] : info.arguments) {
    for (const auto& argument : arguments) {
      if (argument.unit.empty()) continue;
      if (auto wrong = wrong_unit(argument.name, argument.unit)) {
        wrong->text = fmt::format("of `{}`: {}", action, wrong->text);
        findings.push_back(*std::move(wrong));
      }
    }
  }
  return findings;
}

}  // namespace parallax::harness
