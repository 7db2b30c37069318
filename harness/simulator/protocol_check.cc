#include "harness/simulator/protocol_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
namespace parallax::harness {
namespace {

constexpr std::array<std::string_view, 3> kDeterminisms = {"bitwise", "tolerance", "none"};
constexpr std::array<std::string_view, 5> kCapabilities = {"describe", "margins", "noise",
                                                           "perform", "poses"};
constexpr double kOvershoot = 0.05;  // share of a limit

template <std::size_t N>
bool is_one_of(const std::array<std::string_view, N>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Adds what is wrong with a name in a list of names that have to differ.
void take_name(const std::string& name, std::string_view what, std::set<std::string>& known,
               std::vector<std::string>& faults) {
  if (name.empty()) {
    faults.push_back(fmt::format("{} has no name", what));
  } else if (!known.insert(name).second) {
    faults.push_back(fmt::format("`{}` is declared twice", name));
  }
}

void check_parameters(const SimulatorInfo& info, std::vector<std::string>& faults) {
  std::set<std::string> names;
  for (const Parameter& parameter : info.parameters) {
    take_name(parameter.name, "a variable", names, faults);
    if (parameter.name == kLostVariable) {
      faults.push_back(fmt::format("a variable may not be called `{}`", kLostVariable));
    }
    if (parameter.lower && parameter.upper && *parameter.lower > *parameter.upper) {
      faults.push_back(fmt::format("the bounds of `{}` are reversed", parameter.name));
    }
  }
}

}  // namespace

std::vector<std::string> info_faults(const SimulatorInfo& info) {
  std::vector<std::string> faults;
  if (info.name.empty()) faults.emplace_back("it has no name");
  if (!is_one_of(kDeterminisms, info.determinism)) {
    faults.push_back(
        fmt::format("`determinism` is `{}`, which is neither bitwise, tolerance nor "
                    "none",
                    info.determinism));
  }
  if (!(info.timestep_s >= 0.0)) {
    faults.push_back(fmt::format("`time_step` is {:g} s", info.timestep_s));
  }
  check_parameters(info, faults);
  std::set<std::string> actions;
  for (const auto& action : info.actions) take_name(action, "an action", actions, faults);
  for (const auto& [action, arguments] : info.arguments) {
    std::set<std::string> names;
    std::vector<std::string> found;
    for (const auto& argument : arguments) take_name(argument.name, "an argument", names, found);
    for (const auto& fault : found) faults.push_back(fmt::format("of `{}`: {}", action, fault));
  }
  return faults;
}

std::vector<std::string> info_oddities(const SimulatorInfo& info) {
  std::vector<std::string> out;
  std::set<std::string> words;
  for (const auto& word : info.capabilities) {
    if (!words.insert(word).second) continue;
    if (!is_one_of(kCapabilities, word)) {
      out.push_back(fmt::format("`{}` is no capability that is known here", word));
    }
  }
  return out;
}

double most_sim_time_s(double limit_s, const SimulatorInfo& info) {
  return limit_s + std::max(2.0 * info.timestep_s, kOvershoot * limit_s);
}

std::string outcome_fault(std::string_view action, const Outcome& outcome, double limit_s,
                          const SimulatorInfo& info) {
  if (!std::isfinite(outcome.sim_time_s) || outcome.sim_time_s < 0.0) {
    return fmt::format("`{}` says that it took {:g} s", action, outcome.sim_time_s);
  }
  if (outcome.sim_time_s > 0.0 && info.is_instant(action)) {
    return fmt::format("`{}` is said to be `instant`, and took {:g} s", action, outcome.sim_time_s);
  }
  if (outcome.sim_time_s <= most_sim_time_s(limit_s, info)) return {};
  return fmt::format("`{}` ran {:g} s with a limit of {:g} s", action, outcome.sim_time_s, limit_s);
}

}  // namespace parallax::harness
