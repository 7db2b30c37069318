#include "harness/region/angle_range.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace parallax::harness {

std::optional<std::string> angle_fault(const Interval& angles_rad) {
  constexpr double kTurn_rad = 2.0 * std::numbers::pi, kRounding_rad = 0.05;
  const double lower = angles_rad.lower, upper = angles_rad.upper;
  const double most = std::abs(upper) >= std::abs(lower) ? upper : lower;
  const bool is_wide = upper - lower > kTurn_rad + kRounding_rad;
  const bool is_far = lower > kTurn_rad + kRounding_rad || upper < -kTurn_rad - kRounding_rad;
  if (!is_wide && !is_far) return std::nullopt;
  const auto values =
      lower == upper ? fmt::format("{:g}", lower) : fmt::format("from {:g} to {:g}", lower, upper);
  return fmt::format(
      "is {} rad, and {}; angles are in radians: {:g} degrees are {:.4g} rad", values,
      is_wide ? "a turn is 6.283 rad" : "that is more than a turn, 6.283 rad, away from 0", most,
      most * std::numbers::pi / 180.0);
}

double unwrapped(double angle, const Interval& interval) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  return angle + kTurn * std::round((interval.midpoint() - angle) / kTurn);
}

}  // namespace parallax::harness
