#include "tools/app/region_locator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace parallax::tools {
namespace {

/// The height of a place is that of the lowest point of what lies there.
harness::Point point(const compiler::PlanPose& pose) {
  return {pose.x_m, pose.y_m, pose.z_m, compiler::yaw_rad(pose), pose.z_m};
}

}  // namespace

std::optional<std::string> RegionLocator::region_of(std::string_view function,
                                                    const compiler::PlanPose& pose) const {
  const auto* region = regions_->locate(function, point(pose));
  if (region == nullptr) return std::nullopt;
  return region->name;
}

std::optional<compiler::PoseLocator::Nearest> RegionLocator::nearest(
    std::string_view function, const compiler::PlanPose& pose) const {
  std::optional<Nearest> best;
  const auto at = point(pose);
  for (const auto& region : regions_->regions()) {
    if (!region.frame.empty() || !regions_->answers(function, region)) continue;
    const auto here = distance(region, at);
    if (!best || here.distance_m < best->distance_m) best = here;
  }
  return best;
}

std::optional<base::SourceRange> RegionLocator::place_of(std::string_view name) const {
  for (const auto& region : regions_->regions()) {
    if (region.name == name) return region.source;
  }
  return std::nullopt;
}

compiler::PoseLocator::Nearest RegionLocator::distance(const harness::Region& region,
                                                       const harness::Point& at) const {
  double squared_m2 = 0.0;
  std::string outside;
  for (const auto axis : harness::kRegionAxes) {
    const auto& bound = region.on(axis);
    if (!bound) continue;
    const double value = at[static_cast<std::size_t>(axis)];
    const double outside_m = std::max({bound->lower - value, value - bound->upper, 0.0});
    if (axis == harness::RegionAxis::kYaw ? contains_yaw(region, at) : outside_m == 0.0) continue;
    if (axis != harness::RegionAxis::kYaw) squared_m2 += outside_m * outside_m;
    outside += fmt::format("{}{}: {:.4g} is not from {:.4g} to {:.4g}", outside.empty() ? "" : "; ",
                           to_string(axis), value, bound->lower, bound->upper);
  }
  return {region.name, std::sqrt(squared_m2), outside};
}

bool RegionLocator::contains_yaw(const harness::Region& region, const harness::Point& at) const {
  auto moved = at;
  for (const auto axis : harness::kRegionAxes) {
    const auto& bound = region.on(axis);
    if (bound && axis != harness::RegionAxis::kYaw) {
      moved[static_cast<std::size_t>(axis)] = bound->midpoint();
    }
  }
  return regions_->contains(region, moved);
}

}  // namespace parallax::tools
