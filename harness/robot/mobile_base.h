#pragma once

#include <Eigen/Core>

#include "harness/engine/ode_world.h"
#include "harness/robot/axis_servo.h"
#include "harness/robot/line_servo.h"

namespace parallax::harness {

/// Position in the plane [m] and heading [rad].
struct PlanarPose {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();
  double yaw_rad = 0.0;
};

/// `angle_rad` moved by full turns into (-pi, pi].
double wrapped(double angle_rad);

/// A base that drives straight lines and turns on the spot. Its wheels follow the floor's relief,
/// a sine of the way driven, so that what it carries is shaken by the square of its speed.
class MobileBase {
 public:
  MobileBase(const MobileRobotSpec& spec, OdeWorld& world);

  void reset();
  void drive_to(const Eigen::Vector2d& target, const Motion& motion);
  void turn_to(double yaw_rad, const Motion& motion);  // the shorter way
  void brake();
  bool at_rest() const { return line_.at_rest() && turn_.at_rest(); }

  PlanarPose pose() const;
  BodyId body() const { return body_; }
  /// A point of the base frame B, in the world.
  Eigen::Vector3d to_world(const Eigen::Vector3d& p_B) const;
  Eigen::Vector3d heading() const;  // x axis of B in the world, level

  void drive_motors();

 private:
  OdeWorld& world_;
  BodyId body_;
  GantryId gantry_;
  double amplitude_m_, wave_number_rad_m_;
  LineServo line_;  // z unused
  AxisServo turn_;  // on the unwrapped heading
  double yaw_rad_ = 0.0;
  double driven_m_ = 0.0;
  Eigen::Vector2d last_ = Eigen::Vector2d::Zero();
};

}  // namespace parallax::harness
