#pragma once

#include <optional>
#include <string>

#include "harness/region/region.h"

namespace parallax::harness {

/// Says why an interval of angles [rad], or one angle, cannot be meant in radians. None if it can.
/// It is wider than a turn, or lies more than a turn away from 0: such numbers are degrees.
std::optional<std::string> angle_fault(const Interval& angles_rad);

/// The representation of an angle that lies nearest to the middle of `interval` [rad].
double unwrapped(double angle, const Interval& interval);

}  // namespace parallax::harness
