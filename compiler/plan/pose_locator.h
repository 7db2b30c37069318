#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "compiler/base/source_file.h"

namespace parallax::compiler {

/// A pose of a plan: position [m] and unit quaternion in a named frame.
struct PlanPose {
  std::string frame = "map";
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;
  double qx = 0.0, qy = 0.0, qz = 0.0, qw = 1.0;
  friend bool operator==(const PlanPose&, const PlanPose&) = default;
};

/// Rotation about the vertical axis of the pose's quaternion [rad], in (-pi, pi].
inline double yaw_rad(const PlanPose& p) {
  return std::atan2(2.0 * (p.qw * p.qz + p.qx * p.qy), 1.0 - 2.0 * (p.qy * p.qy + p.qz * p.qz));
}

/// The mapping from continuous poses to the model's constants. The caller answers with the same
/// regions that the simulation maps states with, so that plan and simulator cannot disagree.
/// `function` is one of `region`, `place` and `gaze`.
class PoseLocator {
 public:
  virtual ~PoseLocator() = default;
  /// The region of that function that contains the pose; none outside all of them.
  virtual std::optional<std::string> region_of(std::string_view function,
                                               const PlanPose& pose) const = 0;
  struct Nearest {
    std::string region;
    double distance_m = 0.0;
    /// "bottom: 0.85 is above 0.5": each dimension on which the pose is outside.
    std::string outside = {};
  };
  /// For messages: the region nearest to a pose outside; none if the function has no regions.
  virtual std::optional<Nearest> nearest(std::string_view function, const PlanPose& pose) const = 0;
  /// For messages: where a region of this name is defined.
  virtual std::optional<base::SourceRange> place_of(std::string_view /*region*/) const {
    return std::nullopt;
  }
};

/// Locator for a model without regions: no pose lies in one.
class NoRegions final : public PoseLocator {
 public:
  std::optional<std::string> region_of(std::string_view, const PlanPose&) const override {
    return std::nullopt;
  }
  std::optional<Nearest> nearest(std::string_view, const PlanPose&) const override {
    return std::nullopt;
  }
};

}  // namespace parallax::compiler
