#pragma once

#include <Eigen/Core>
#include <variant>
#include <vector>

#include "harness/engine/jaws.h"
#include "harness/engine/physics_world.h"
#include "harness/robot/palm_chain.h"
#include "harness/robot/palm_gantry.h"
#include "harness/robot/servo.h"

namespace parallax::harness {

/// A gripper on a gantry or on a chain of joints. The tool is the middle between the open pads; it
/// hangs under the palm's axis, so that a turn of the wrist does not move it.
class Arm {
 public:
  Arm(const WorldSpec& world_spec, const ArmSpec& spec, std::uint32_t gripper, PhysicsWorld& world);

  void reset();
  /// Moves the tool straight to a point of the world, as the base stands now; a base that drives
  /// takes it along.
  void move_tool_to(const Eigen::Vector3d& target_W, const Motion& motion);
  /// Moves the tool by `angle_rad` round the vertical through a point of the world. The wrist turns
  /// with it, as a held body does; `motion` is in radians.
  void lead_tool_round(const Eigen::Vector3d& centre_W, double angle_rad, const Motion& motion);
  /// Turns the line of the pads against what the arm hangs on, the shorter way; 0: as it is by
  /// default.
  void turn_wrist_to(double yaw_rad, const Motion& motion);
  /// For a chain: the next straight motion turns the wrist to `yaw_rad` on its way.
  void aim_wrist(double yaw_rad);
  /// For a chain: moves through positions of its joints.
  void swing_along(ChainWay way, const Motion& motion);
  void open_to(double opening_m, const Motion& motion);
  /// Presses the far pad towards the near one until the next opening.
  void squeeze(double force_n, double speed_m_s);
  void brake();
  bool tool_at_rest() const;
  bool finger_at_rest() const { return finger_.at_rest(); }
  /// The force of the squeeze that lasts [N]; 0: the fingers were opened, or never closed.
  double squeeze_n() const { return finger_.is_pushing() ? finger_force_n_ : 0.0; }
  /// Acceleration of the tool against the arm's mount, as motions ask for it [m/s2].
  double asked_acceleration() const;

  Eigen::Vector3d tool() const;  // in the world [m]
  double opening_m() const;
  double wrist_rad() const;
  /// The wrist heading at the end of the next straight motion of the tool.
  double wrist_goal_rad() const;
  /// The direction from the far pad to the near one with the wrist at `wrist_rad`; world, unit.
  Eigen::Vector3d pad_line(double wrist_rad) const;
  /// The middle of the palm, seen from the tool [m]; the same whatever way the wrist is turned.
  Eigen::Vector3d palm_offset() const;
  /// How far the palm reaches from its middle along `direction_W` once the wrist is at `wrist_rad`.
  double palm_half_extent_m(const Eigen::Vector3d& direction_W, double wrist_rad) const;
  const ArmSpec& spec() const { return spec_; }
  std::uint32_t gripper() const { return gripper_; }
  /// All bodies that move with the palm.
  const std::vector<BodyId>& bodies() const { return bodies_; }
  /// The chain that carries the palm; null if it is a gantry.
  const PalmChain* chain() const { return std::get_if<PalmChain>(&carrier_); }

  void drive_motors();

 private:
  ArmSpec spec_;
  std::uint32_t gripper_;
  PhysicsWorld& world_;
  std::variant<PalmGantry, PalmChain> carrier_;
  SliderId finger_joint_;
  BodyId palm_;
  Jaws jaws_;
  std::vector<BodyId> bodies_;
  double finger_force_n_ = 0.0;
  AxisServo finger_;
};

}  // namespace parallax::harness
