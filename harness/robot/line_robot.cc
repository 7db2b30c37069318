#include "harness/robot/line_robot.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "compiler/base/contract.h"
#include "harness/engine/extent_along.h"

namespace parallax::harness {
namespace {

SliderId slider_named(const PhysicsWorld& world, std::string_view name) {
  const std::optional<SliderId> id = world.layout().find_slider(name);
  PARALLAX_REQUIRE(id.has_value(), "a robot whose joints exist");
  return *id;
}

BodyId body_named(const PhysicsWorld& world, std::string_view name) {
  const std::optional<BodyId> id = world.layout().find_body(name);
  PARALLAX_REQUIRE(id.has_value(), "a robot whose bodies exist");
  return *id;
}

}  // namespace

LineRobot::LineRobot(const WorldSpec& spec, PhysicsWorld& world) : world_(world) {
  const LineRobotSpec& roles = spec.robot;
  drive(LineAxis::kBase).slider = slider_named(world, roles.base_joint);
  drive(LineAxis::kReach).slider = slider_named(world, roles.reach_joint);
  drive(LineAxis::kLift).slider = slider_named(world, roles.lift_joint);
  drive(LineAxis::kFinger).slider = slider_named(world, roles.finger_joint);
  base_ = body_named(world, roles.base_body);
  near_pad_ = body_named(world, roles.near_pad_body);
  far_pad_ = body_named(world, roles.far_pad_body);

  // The world is fresh, hence at its default placement.
  const Eigen::Vector3d axis = joint(LineAxis::kFinger).axis_W.normalized();
  const AxisExtent near = extent_along(world, near_pad_, axis);
  const AxisExtent far = extent_along(world, far_pad_, axis);
  closing_sign_ = near.middle_m < far.middle_m ? -1.0 : 1.0;
  open_gap_m_ = std::abs(near.middle_m - far.middle_m) - near.half_m - far.half_m;
}

void LineRobot::reset() {
  for (const LineAxis axis :
       {LineAxis::kBase, LineAxis::kReach, LineAxis::kLift, LineAxis::kFinger}) {
    drive(axis).max_force_n = joint(axis).max_force_n;
    drive(axis).servo.reset(position_m(axis));
  }
}

void LineRobot::move_to(LineAxis axis, double target_m, const Motion& motion) {
  drive(axis).max_force_n = joint(axis).max_force_n;
  drive(axis).servo.move_to(target_m, motion);
}

void LineRobot::brake(LineAxis axis) { drive(axis).servo.brake(); }

void LineRobot::brake_all() {
  // A closed gripper keeps squeezing: an action cut short does not drop what is held.
  for (const LineAxis axis : {LineAxis::kBase, LineAxis::kReach, LineAxis::kLift}) brake(axis);
}

void LineRobot::squeeze(double force_n, double speed_m_s, double acceleration_m_s2) {
  drive(LineAxis::kFinger).max_force_n = force_n;
  drive(LineAxis::kFinger).servo.push(closing_sign_ * speed_m_s, acceleration_m_s2);
}

double LineRobot::squeeze_n() const {
  const Drive& finger = drive(LineAxis::kFinger);
  return finger.servo.is_pushing() ? finger.max_force_n : 0.0;
}

double LineRobot::position_m(LineAxis axis) const {
  return world_.slider_position_m(drive(axis).slider);
}

double LineRobot::beyond_stops_m(LineAxis axis, double target_m) const {
  const JointSpec& spec = joint(axis);
  if (spec.low_m && target_m < *spec.low_m) return *spec.low_m - target_m;
  if (spec.high_m && target_m > *spec.high_m) return target_m - *spec.high_m;
  return 0.0;
}

double LineRobot::base_x_m() const { return world_.position(base_).x(); }

Eigen::Vector3d LineRobot::tool() const {
  return 0.5 * (world_.position(near_pad_) + world_.position(far_pad_));
}

double LineRobot::opening_m() const {
  return open_gap_m_ - closing_sign_ * position_m(LineAxis::kFinger);
}

double LineRobot::finger_position_for(double opening_m) const {
  const JointSpec& spec = joint(LineAxis::kFinger);
  const double wanted = closing_sign_ * (open_gap_m_ - opening_m);
  return std::clamp(wanted, spec.low_m.value_or(wanted), spec.high_m.value_or(wanted));
}

void LineRobot::drive_motors() {
  for (Drive& one : drives_) {
    const double velocity =
        one.servo.next_velocity(world_.slider_position_m(one.slider),
                                world_.slider_rate_m_s(one.slider), world_.timestep_s());
    world_.set_motor(one.slider, velocity, one.max_force_n);
  }
}

}  // namespace parallax::harness
