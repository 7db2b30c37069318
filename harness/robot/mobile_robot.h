#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "harness/engine/ode_world.h"
#include "harness/robot/arm.h"
#include "harness/robot/mobile_base.h"

namespace parallax::harness {

/// The robot of a world with MobileRobotSpec: a base, a lifting torso, arms.
class MobileRobot {
 public:
  MobileRobot(const WorldSpec& spec, OdeWorld& world);

  /// All motors at rest where things are.
  void reset();
  void brake_all();
  /// Sets the motors for the next timestep.
  void drive_motors();

  MobileBase& base() { return base_; }
  const MobileBase& base() const { return base_; }
  std::vector<Arm>& arms() { return arms_; }
  const std::vector<Arm>& arms() const { return arms_; }
  Arm* find_arm(std::string_view name);

  bool has_torso() const { return torso_.has_value(); }
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

  const MobileRobotSpec& spec() const { return spec_; }
  /// Every part of the robot.
  const BodyMask& parts() const { return parts_; }

 private:
  MobileRobotSpec spec_;
  OdeWorld& world_;
  MobileBase base_;
  std::vector<Arm> arms_;
  std::optional<SliderId> torso_;
  AxisServo torso_servo_;
  BodyMask parts_;
};

}  // namespace parallax::harness
