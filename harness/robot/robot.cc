#include "harness/robot/robot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include "compiler/base/contract.h"

namespace parallax::harness {
namespace {

SliderId slider_named(const OdeWorld& world, std::string_view name) {
  const std::optional<SliderId> id = world.layout().find_slider(name);
  PARALLAX_REQUIRE(id.has_value(), "a robot whose joints exist");
  return *id;
}

BodyId body_named(const OdeWorld& world, std::string_view name) {
  const std::optional<BodyId> id = world.layout().find_body(name);
  PARALLAX_REQUIRE(id.has_value(), "a robot whose bodies exist");
  return *id;
}

/// Half the extent of a body along `axis`, and the offset of its middle, at the default placement.
struct Extent {
  double middle_m = 0.0, half_m = 0.0;
};

Extent extent_along(const Eigen::Vector3d& axis, const Bounds& bounds) {
  return {axis.dot(0.5 * (bounds.low + bounds.high)),
          0.5 * axis.cwiseAbs().dot(bounds.high - bounds.low)};
}

}  // namespace

Robot::Robot(const WorldSpec& spec, OdeWorld& world) : world_(world) {
  const LineRobotSpec& roles = spec.robot;
  drive(Axis::kBase).slider = slider_named(world, roles.base_joint);
  drive(Axis::kReach).slider = slider_named(world, roles.reach_joint);
  drive(Axis::kLift).slider = slider_named(world, roles.lift_joint);
  drive(Axis::kFinger).slider = slider_named(world, roles.finger_joint);
  base_ = body_named(world, roles.base_body);
  near_pad_ = body_named(world, roles.near_pad_body);
  far_pad_ = body_named(world, roles.far_pad_body);

  // The world is fresh, hence at its default placement.
  const Eigen::Vector3d axis = joint(Axis::kFinger).axis_W.normalized();
  const Extent near = extent_along(axis, world.bounds(near_pad_));
  const Extent far = extent_along(axis, world.bounds(far_pad_));
  closing_sign_ = near.middle_m < far.middle_m ? -1.0 : 1.0;
  open_gap_m_ = std::abs(near.middle_m - far.middle_m) - near.half_m - far.half_m;
}

void Robot::reset() {
  for (const Axis axis : {Axis::kBase, Axis::kReach, Axis::kLift, Axis::kFinger}) {
    drive(axis).max_force_n = joint(axis).max_force_n;
    drive(axis).servo.reset(position_m(axis));
  }
}

void Robot::move_to(Axis axis, double target_m, const Motion& motion) {
  drive(axis).max_force_n = joint(axis).max_force_n;
  drive(axis).servo.move_to(target_m, motion);
}

void Robot::brake(Axis axis) { drive(axis).servo.brake(); }

void Robot::brake_all() {
  // A closed gripper keeps squeezing: an action cut short does not drop what is held.
  for (const Axis axis : {Axis::kBase, Axis::kReach, Axis::kLift}) brake(axis);
}

void Robot::squeeze(double force_n, double speed_m_s, double acceleration_m_s2) {
  drive(Axis::kFinger).max_force_n = force_n;
  drive(Axis::kFinger).servo.push(closing_sign_ * speed_m_s, acceleration_m_s2);
}

double Robot::position_m(Axis axis) const { return world_.slider_position_m(drive(axis).slider); }

double Robot::beyond_stops_m(Axis axis, double target_m) const {
  const JointSpec& spec = joint(axis);
  if (spec.low_m && target_m < *spec.low_m) return *spec.low_m - target_m;
  if (spec.high_m && target_m > *spec.high_m) return target_m - *spec.high_m;
  return 0.0;
}

double Robot::low_stop_m(Axis axis) const {
  return joint(axis).low_m.value_or(-std::numeric_limits<double>::infinity());
}

double Robot::base_x_m() const { return world_.position(base_).x(); }

Eigen::Vector3d Robot::tool() const {
  return 0.5 * (world_.position(near_pad_) + world_.position(far_pad_));
}

double Robot::opening_m() const { return open_gap_m_ - closing_sign_ * position_m(Axis::kFinger); }

double Robot::finger_position_for(double opening_m) const {
  const JointSpec& spec = joint(Axis::kFinger);
  const double wanted = closing_sign_ * (open_gap_m_ - opening_m);
  return std::clamp(wanted, spec.low_m.value_or(wanted), spec.high_m.value_or(wanted));
}

void Robot::drive_motors() {
  for (Drive& one : drives_) {
    const double velocity =
        one.servo.next_velocity(world_.slider_position_m(one.slider),
                                world_.slider_rate_m_s(one.slider), world_.timestep_s());
    world_.set_motor(one.slider, velocity, one.max_force_n);
  }
}

}  // namespace parallax::harness
