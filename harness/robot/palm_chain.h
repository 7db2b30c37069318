#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "harness/engine/physics_world.h"
#include "harness/kinematics/chain_way.h"
#include "harness/robot/servo.h"
#include "harness/world/chain_arm.h"

namespace parallax::harness {

/// A palm that a chain of joints carries. Each joint has a motor that follows a velocity with no
/// more than its torque; height, roll and pitch of the palm are what the joints make of it. The
/// tool is led along straight lines and turned on the spot, upright in the frame of the body which
/// the chain hangs on, by positions of the joints that are found when the motion begins.
class PalmChain {
 public:
  PalmChain(const WorldSpec& spec, const ArmSpec& arm, PhysicsWorld& world);

  void reset();
  /// Leads the tool straight to a point of the world, as the robot stands now. Where the chain
  /// cannot follow the whole way, it goes as far as it can.
  void lead_to(const Eigen::Vector3d& target_W, const Motion& motion);
  /// Leads the tool by `angle_rad` round the vertical through a point of the world, the wrist
  /// turning with it, as far as the chain can follow; `motion` is in radians.
  void lead_round(const Eigen::Vector3d& centre_W, double angle_rad, const Motion& motion);
  /// The positions of the joints on such a way of the upright tool, from those that have it at
  /// `from_W` with the wrist turned to `wrist_rad`.
  ChainWay arc_way(const JointVector& start, const Eigen::Vector3d& from_W, double wrist_rad,
                   const Eigen::Vector3d& centre_W, double angle_rad,
                   const ChainCheck& check) const;
  /// Moves through positions of all joints, whatever way the tool takes; `motion` is that of the
  /// joint which turns farthest. At the end the wrist is turned as before.
  void swing_along(ChainWay way, const Motion& motion);
  /// Turns the wrist the shorter way, against the chain's root.
  void turn_to(double yaw_rad, const Motion& motion);
  /// The next line turns the wrist to `yaw_rad` on its way.
  void aim_wrist(double yaw_rad);
  void brake();
  bool at_rest() const { return along_.at_rest(); }
  /// An upper bound on the acceleration of the tool against the root [m/s2].
  double asked_acceleration() const;
  double wrist_rad() const;
  /// The wrist heading at the end of a line.
  double wrist_goal_rad() const { return wrist_goal_rad_; }
  void drive_motors();

  const ChainArm& arm() const { return arm_; }
  JointVector positions() const;
  Eigen::Isometry3d root() const;  // X_WR
  /// The pose of the upright tool at a point of the world with the wrist turned so, in the root's
  /// frame.
  Eigen::Isometry3d upright(const Eigen::Vector3d& tool_W, double wrist_rad) const;
  /// Can the tool be there, with the wrist turned so? The search begins at the present positions.
  InverseResult reach(const Eigen::Vector3d& tool_W, double wrist_rad) const;

 private:
  enum class Mode : std::uint8_t { kLine, kTurn, kSwing, kArc };
  /// Starts a motion along `way`: in metres of the tool's line or in radians of its turn.
  void start(ChainWay way, const Eigen::Isometry3d& goal, const Motion& motion);
  double way_done();
  JointVector led_rates(double share, double share_per_s, double off) const;

  PhysicsWorld& world_;
  ChainArm arm_;
  std::vector<std::variant<HingeId, SliderId>> joints_;
  double start_yaw_rad_ = 0.0;  // of the palm against the root at positions 0

  ChainWay way_;
  Eigen::Isometry3d from_ = Eigen::Isometry3d::Identity();  // where the way begins
  Eigen::Vector3d ahead_ = Eigen::Vector3d::Zero();         // of the line, or axis of the turn
  double length_ = 0.0;
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();  // of the arc, in the root's frame
  double arc_rad_ = 0.0, turned_rad_ = 0.0;  // of the arc: the whole and what is done of it
  Mode mode_ = Mode::kLine;
  AxisServo along_;
  double wrist_goal_rad_ = 0.0;
};

}  // namespace parallax::harness
