#pragma once

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
  /// The shorter way, against the parent of the gantry.
  void turn_to(double yaw_rad, const Motion& motion);
  void brake();
  bool at_rest() const { return line_.at_rest() && wrist_.at_rest(); }
  double wrist_rad() const { return world_.gantry_yaw_rad(gantry_); }
  void drive_motors();

 private:
  PhysicsWorld& world_;
  GantryId gantry_;
  double wrist_unwrapped_rad_ = 0.0;
  LineServo line_;  // gantry position
  AxisServo wrist_;
};

}  // namespace parallax::harness
