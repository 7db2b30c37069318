#include "harness/campaign/start_echo.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "harness/region/state_mapping.h"

namespace parallax::harness {
namespace {

constexpr std::int64_t kLeastEchoes = 10;
constexpr double kEchoShare = 0.1;  // of the width that was drawn from

std::optional<double> start_number(const Value& value) {
  if (const auto* real = std::get_if<double>(&value)) return *real;
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
  return std::nullopt;
}

}  // namespace

void StartEcho::add(const SampleRecord& record) {
  if (record.observations.empty()) return;
  const auto& seen = record.observations.front();
  for (const auto& [name, value] : record.initial) {
    const auto drawn = start_number(value);
    const auto found = seen.find(name);
    if (!drawn || found == seen.end()) continue;
    const auto began = start_number(found->second);
    if (!began || !std::isfinite(*began)) continue;
    auto off = *began - *drawn;
    if (is_angle(name)) off = std::remainder(off, 2.0 * std::numbers::pi);
    auto& variable = variables_[name];
    if (variable.runs++ == 0) {
      variable.low_drawn = variable.high_drawn = *drawn;
      variable.low_seen = variable.high_seen = *began;
    }
    variable.low_drawn = std::min(variable.low_drawn, *drawn);
    variable.high_drawn = std::max(variable.high_drawn, *drawn);
    variable.low_seen = std::min(variable.low_seen, *began);
    variable.high_seen = std::max(variable.high_seen, *began);
    variable.squares += off * off;
  }
}

std::vector<std::string> StartEcho::faults() const {
  std::vector<std::string> out;
  for (const auto& [name, variable] : variables_) {
    const double width = variable.high_drawn - variable.low_drawn;
    if (variable.runs < kLeastEchoes || width <= 0.0) continue;
    if (std::sqrt(variable.squares / static_cast<double>(variable.runs)) <= kEchoShare * width)
      continue;
    out.push_back(
        fmt::format("`{}` was drawn from {:.4g} to {:.4g}, and by the first observations the "
                    "simulations began at {}: the simulator "
                    "does not take this start, and nothing is claimed about it",
                    name, variable.low_drawn, variable.high_drawn,
                    variable.low_seen == variable.high_seen
                        ? fmt::format("{:.4g}", variable.low_seen)
                        : fmt::format("{:.4g} to {:.4g}, elsewhere than each was drawn",
                                      variable.low_seen, variable.high_seen)));
  }
  return out;
}

}  // namespace parallax::harness
