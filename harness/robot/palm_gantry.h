#pragma once

#include <Eigen/Core>
#include <optional>

#include "harness/engine/physics_world.h"
#include "harness/robot/servo.h"

namespace parallax::harness {

/// A palm that a gantry carries: upright at all times, whatever it holds, and with nothing between
/// it and the robot that could meet anything. The fast model of an arm.
class PalmGantry {
 public:
  PalmGantry(const ArmSpec& spec, PhysicsWorld& world);

  void reset();
  /// Leads the tool, which is at `tool_W`, straight to a point of the world as things stand.
  void lead_to(const Eigen::Vector3d& tool_W, const Eigen::Vector3d& target_W,
               const Motion& motion);
  /// Leads it by `angle_rad` round the vertical through a point of the world, the wrist turning
  /// with it; `motion` is in radians.
  void lead_round(const Eigen::Vector3d& tool_W, const Eigen::Vector3d& centre_W, double angle_rad,
                  const Motion& motion);
  /// The shorter way, against the parent of the gantry.
  void turn_to(double yaw_rad, const Motion& motion);
  void brake();
  bool at_rest() const;
  double wrist_rad() const { return world_.gantry_yaw_rad(gantry_); }
  /// The acceleration of the tool against what the gantry hangs on [m/s2].
  double asked_acceleration() const {
    return arc_ ? arc_->asked_acceleration() : line_.asked_acceleration();
  }
  void drive_motors();

 private:
  /// The line and the wrist keep the place that the arc has led to.
  void end_arc();
  /// A way in the world along the axes of the gantry.
  Eigen::Vector3d in_gantry(const Eigen::Vector3d& way_W) const;

  PhysicsWorld& world_;
  GantryId gantry_;
  double wrist_unwrapped_rad_ = 0.0;
  LineServo line_;  // gantry position
  AxisServo wrist_;
  std::optional<ArcServo> arc_;  // then in place of both
  double arc_wrist_rad_ = 0.0;   // where the wrist began, unwrapped
};

}  // namespace parallax::harness
