#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "harness/engine/jaws.h"
#include "harness/engine/ode_world.h"
#include "harness/robot/servo.h"

namespace parallax::harness {

/// A gripper on a gantry. The tool is the middle between the open pads; it hangs under the palm's
/// axis, so that a turn of the wrist does not move it.
class Arm {
 public:
  Arm(const ArmSpec& spec, std::uint32_t gripper, OdeWorld& world);

  void reset();
  /// Straight to a point of the world, as the base stands now; a base that drives takes it along.
  void move_tool_to(const Eigen::Vector3d& target_W, const Motion& motion);
  /// Line of the pads against the parent of the gantry, the shorter way; 0: they squeeze along y.
  void turn_wrist_to(double yaw_rad, const Motion& motion);
  void open_to(double opening_m, const Motion& motion);
  /// Presses the far pad towards the near one until the next opening.
  void squeeze(double force_n, double speed_m_s);
  void brake();
  bool tool_at_rest() const { return line_.at_rest() && wrist_.at_rest(); }
  bool finger_at_rest() const { return finger_.at_rest(); }

  Eigen::Vector3d tool() const;  // in the world [m]
  double opening_m() const;
  double wrist_rad() const;
  /// From the far pad to the near one once the wrist is at `wrist_rad`; world, unit.
  Eigen::Vector3d pad_line(double wrist_rad) const;
  /// The middle of the palm, seen from the tool [m]; the same whatever way the wrist is turned.
  Eigen::Vector3d palm_offset() const;
  /// How far the palm reaches from its middle along `direction_W` once the wrist is at `wrist_rad`.
  double palm_half_extent_m(const Eigen::Vector3d& direction_W, double wrist_rad) const;
  const ArmSpec& spec() const { return spec_; }
  std::uint32_t gripper() const { return gripper_; }
  /// All bodies that move with the palm.
  const std::vector<BodyId>& bodies() const { return bodies_; }

  void drive_motors();

 private:
  ArmSpec spec_;
  std::uint32_t gripper_;
  OdeWorld& world_;
  GantryId gantry_;
  SliderId finger_joint_;
  BodyId palm_;
  Jaws jaws_;
  std::vector<BodyId> bodies_;
  double finger_force_n_ = 0.0;
  double wrist_unwrapped_rad_ = 0.0;
  LineServo line_;  // gantry position
  AxisServo wrist_, finger_;
};

}  // namespace parallax::harness
