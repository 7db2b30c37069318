#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "compiler/plan/pose_locator.h"
#include "harness/region/region.h"

namespace parallax::tools {

/// Locates the poses of a plan with the regions that the simulation is mapped with. An angle counts
/// as outside, not as a distance; a place is a point that something lies at.
class RegionLocator final : public compiler::PoseLocator {
 public:
  /// `regions` outlives the object.
  explicit RegionLocator(const harness::RegionMap& regions) : regions_(&regions) {}

  std::optional<std::string> region_of(std::string_view function,
                                       const compiler::PlanPose& pose) const override;
  std::optional<Nearest> nearest(std::string_view function,
                                 const compiler::PlanPose& pose) const override;
  std::optional<base::SourceRange> place_of(std::string_view name) const override;

 private:
  Nearest distance(const harness::Region& region, const harness::Point& at) const;
  bool contains_yaw(const harness::Region& region, const harness::Point& at) const;

  const harness::RegionMap* regions_;
};

}  // namespace parallax::tools
