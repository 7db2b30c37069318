#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

#include "harness/engine/physics_world.h"
#include "harness/robot/arm.h"
#include "harness/robot/servo.h"

namespace parallax::harness {

/// Tolerances of the controllers' judgements, which proofs about them rest on.
inline constexpr double kParkedWithin_m = 0.03;       // of the tool from where it is carried
inline constexpr double kTorsoTolerance_m = 0.005;    // of the height that it was to go to
inline constexpr double kTurnStep_rad = 0.035;        // between the headings that a drive tries
inline constexpr double kWristTolerance_rad = 0.005;  // of the heading that a hand is turned to
inline constexpr double kFingerTolerance_m = 0.001;   // of the opening that it was to have
inline constexpr double kBeyondStop_m = 0.005;        // a hand leads on, so that it stops

/// Position in the plane [m] and heading [rad].
struct PlanarPose {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();
  double yaw_rad = 0.0;
};

/// Accelerations that motions ask for, level and upright [m/s2].
struct AskedAcceleration {
  double level = 0.0, upright = 0.0;
};

/// A base that drives straight lines and turns on the spot. Its wheels follow the floor's relief,
/// a sine of the way driven, so that what it carries is shaken by the square of its speed.
class MobileBase {
 public:
  MobileBase(const MobileRobotSpec& spec, PhysicsWorld& world);

  void reset();
  void drive_to(const Eigen::Vector2d& target, const Motion& motion);
  void turn_to(double yaw_rad, const Motion& motion);  // the shorter way
  void brake();
  bool at_rest() const { return line_.at_rest() && turn_.at_rest(); }
  /// The accelerations of a point of the world that the base carries. The relief of the floor
  /// shakes it with the square of the speed.
  AskedAcceleration asked_acceleration(const Eigen::Vector3d& p_W) const;

  PlanarPose pose() const;
  BodyId body() const { return body_; }
  /// A point of the base frame B, in the world.
  Eigen::Vector3d to_world(const Eigen::Vector3d& p_B) const;
  Eigen::Vector3d heading() const;  // x axis of B in the world, level

  void drive_motors();

 private:
  PhysicsWorld& world_;
  BodyId body_;
  GantryId gantry_;
  double amplitude_m_, wave_number_rad_m_;
  LineServo line_;  // z unused
  AxisServo turn_;  // on the unwrapped heading
  double yaw_rad_ = 0.0;
  double driven_m_ = 0.0;
  Eigen::Vector2d last_ = Eigen::Vector2d::Zero();
};

/// The robot of a world with MobileRobotSpec: a base, a lifting torso, arms.
class MobileRobot {
 public:
  MobileRobot(const WorldSpec& spec, PhysicsWorld& world);

  /// Brings all motors to rest at the present positions.
  void reset();
  void brake_all();
  /// Sets the motors for the next timestep.
  void drive_motors();

  MobileBase& base() { return base_; }
  const MobileBase& base() const { return base_; }
  std::vector<Arm>& arms() { return arms_; }
  const std::vector<Arm>& arms() const { return arms_; }
  Arm* find_arm(std::string_view name);

  double lift_m() const;  // of the torso above its lowest; 0 without one
  void lift_to(double height_m, const Motion& motion);
  bool torso_at_rest() const { return torso_servo_.at_rest(); }
  /// Is the height within the stops?
  bool lift_allowed(double height_m) const;

  /// A point of the base frame that the torso carries, in the world.
  Eigen::Vector3d carried_to_world(const Eigen::Vector3d& p_B) const;
  Eigen::Vector3d shoulder(const Arm& arm) const { return carried_to_world(arm.spec().p_BS); }
  Eigen::Vector3d carry_point(const Arm& arm) const { return carried_to_world(arm.spec().carry_B); }
  Eigen::Vector3d camera() const { return carried_to_world(spec_.camera.p_BC); }
  /// Is the tool where parking leaves it?
  bool parked(const Arm& arm) const;
  bool open(const Arm& arm) const;
  /// Upper bounds for the accelerations of the arm's tool: an arm may move it in any direction.
  AskedAcceleration asked_acceleration(const Arm& arm) const;

  const MobileRobotSpec& spec() const { return spec_; }
  /// Every part of the robot.
  const BodyMask& parts() const { return parts_; }

 private:
  MobileRobotSpec spec_;
  PhysicsWorld& world_;
  MobileBase base_;
  std::vector<Arm> arms_;
  std::optional<SliderId> torso_;
  AxisServo torso_servo_;
  BodyMask parts_;
};

}  // namespace parallax::harness
