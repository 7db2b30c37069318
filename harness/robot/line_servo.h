#pragma once

#include <Eigen/Core>

#include "harness/robot/axis_servo.h"

namespace parallax::harness {

/// Velocity command of a point that is to move along straight lines, advanced once per timestep.
/// The way along the line is an AxisServo's; what lies beside the line is taken back in proportion.
class LineServo {
 public:
  /// At rest at `position`, and keeps it.
  void reset(const Eigen::Vector3d& position);
  /// From where it is (as measured) straight to `target`.
  void move_to(const Eigen::Vector3d& position, const Eigen::Vector3d& target,
               const Motion& motion);
  void brake() { along_.brake(); }
  Eigen::Vector3d next_velocity(const Eigen::Vector3d& position, double timestep_s);
  bool at_rest() const { return along_.at_rest(); }

 private:
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction_ = Eigen::Vector3d::UnitX();
  AxisServo along_;
};

}  // namespace parallax::harness
