#include "harness/monitor/near_border.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "harness/region/angle_range.h"
#include "harness/region/area.h"

namespace parallax::harness {
namespace {

/// How far a value is inside of an interval; negative: outside.
double depth_in(const Interval& interval, double value) {
  return std::min(value - interval.lower, interval.upper - value);
}

/// The same on the circle. A full turn has no border.
double angle_depth_in(const Interval& interval, double value) {
  if (interval.width() >= 2.0 * std::numbers::pi) return std::numbers::pi;
  return depth_in(interval, unwrapped(value, interval));
}

}  // namespace

Nearness nearness_of(const Region& region, const Point& point, const ReadingTolerance& tolerance) {
  bool certain = true;
  const auto take = [&](double depth, double slack) {
    if (depth < -slack) return false;
    certain = certain && depth > slack;
    return true;
  };
  for (const RegionAxis axis : kRegionAxes) {
    const auto& bound = region.on(axis);
    if (!bound) continue;
    const double value = point[static_cast<std::size_t>(axis)];
    const bool possible = axis == RegionAxis::kYaw
                              ? take(angle_depth_in(*bound, value), tolerance.rad)
                              : take(depth_in(*bound, value), tolerance.m);
    if (!possible) return Nearness::kOutside;
  }
  if (region.area) {
    // Both coordinates may be off, which moves the point by up to the diagonal.
    const double depth = region.area->signed_distance_m({point[0], point[1]});
    if (!take(depth, std::numbers::sqrt2 * tolerance.m)) return Nearness::kOutside;
  }
  return certain ? Nearness::kInside : Nearness::kBorder;
}

}  // namespace parallax::harness
