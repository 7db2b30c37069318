#include "harness/robot/mobile_robot.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "harness/world/angles.h"

namespace parallax::harness {
namespace {

constexpr double kOpenWithin_m = 0.01;

Eigen::Vector3d level(const Eigen::Vector2d& p) { return {p.x(), p.y(), 0.0}; }

}  // namespace

MobileBase::MobileBase(const MobileRobotSpec& spec, PhysicsWorld& world)
    : world_(world),
      body_(*world.layout().find_body(spec.base_body)),
      gantry_(*world.layout().find_gantry(spec.base_joint)),
      amplitude_m_(spec.relief_amplitude_m),
      wave_number_rad_m_(2.0 * std::numbers::pi / spec.relief_wavelength_m) {}

void MobileBase::reset() {
  const PlanarPose now = pose();
  line_.reset(level(now.p));
  yaw_rad_ = now.yaw_rad;
  turn_.reset(yaw_rad_);
  driven_m_ = 0.0;
  last_ = now.p;
}

void MobileBase::drive_to(const Eigen::Vector2d& target, const Motion& motion) {
  line_.move_to(level(pose().p), level(target), motion);
}

void MobileBase::turn_to(double yaw_rad, const Motion& motion) {
  turn_.move_to(yaw_rad_ + wrapped(yaw_rad - yaw_rad_), motion);
}

void MobileBase::brake() {
  line_.brake();
  turn_.brake();
}

AskedAcceleration MobileBase::asked_acceleration(const Eigen::Vector3d& p_W) const {
  const double radius_m = (p_W - world_.position(body_)).head<2>().norm();
  const double rate_rad_s = turn_.asked_velocity();
  const double shaken_rad_s = wave_number_rad_m_ * line_.asked_speed();
  return {line_.asked_acceleration() +
              radius_m * (turn_.asked_acceleration() + rate_rad_s * rate_rad_s),
          amplitude_m_ * shaken_rad_s * shaken_rad_s};
}

PlanarPose MobileBase::pose() const {
  const Eigen::Matrix3d R = world_.rotation(body_);
  return {world_.position(body_).head<2>(), heading_rad(R)};
}

Eigen::Vector3d MobileBase::to_world(const Eigen::Vector3d& p_B) const {
  return world_.position(body_) + world_.rotation(body_) * p_B;
}

Eigen::Vector3d MobileBase::heading() const {
  const double yaw = pose().yaw_rad;
  return {std::cos(yaw), std::sin(yaw), 0.0};
}

void MobileBase::drive_motors() {
  const double step_s = world_.timestep_s();
  const PlanarPose now = pose();
  yaw_rad_ += wrapped(now.yaw_rad - yaw_rad_);
  driven_m_ += (now.p - last_).norm();
  last_ = now.p;
  Eigen::Vector3d velocity = line_.next_velocity(level(now.p), step_s);
  const double next_m = driven_m_ + velocity.head<2>().norm() * step_s;
  const double height_m = amplitude_m_ * std::sin(wave_number_rad_m_ * next_m);
  velocity.z() = (height_m - world_.gantry_position_m(gantry_).z()) / step_s;
  world_.set_gantry(gantry_, velocity, turn_.next_velocity(yaw_rad_, 0.0, step_s));
}

MobileRobot::MobileRobot(const WorldSpec& spec, PhysicsWorld& world)
    : spec_(*spec.mobile), world_(world), base_(spec_, world) {
  std::uint32_t gripper = 0;
  for (const ArmSpec& arm : spec_.arms) arms_.emplace_back(spec, arm, gripper++, world);
  torso_ = world.layout().find_slider(spec_.torso_joint);
  const std::uint32_t assembly = world.layout().assembly_of[base_.body().index()];
  for (const std::uint32_t other : world.layout().assembly_of) parts_.push_back(other == assembly);
}

void MobileRobot::reset() {
  base_.reset();
  for (Arm& arm : arms_) arm.reset();
  if (torso_) torso_servo_.reset(world_.slider_position_m(*torso_));
}

void MobileRobot::brake_all() {
  base_.brake();
  for (Arm& arm : arms_) arm.brake();
  torso_servo_.brake();
}

void MobileRobot::drive_motors() {
  base_.drive_motors();
  for (Arm& arm : arms_) arm.drive_motors();
  if (!torso_) return;
  const double speed = torso_servo_.next_velocity(
      world_.slider_position_m(*torso_), world_.slider_rate_m_s(*torso_), world_.timestep_s());
  world_.set_motor(*torso_, speed, world_.layout().sliders[*torso_].max_force_n);
}

Arm* MobileRobot::find_arm(std::string_view name) {
  const auto found = std::find_if(arms_.begin(), arms_.end(),
                                  [&](const Arm& arm) { return arm.spec().name == name; });
  return found == arms_.end() ? nullptr : &*found;
}

double MobileRobot::lift_m() const { return torso_ ? world_.slider_position_m(*torso_) : 0.0; }

void MobileRobot::lift_to(double height_m, const Motion& motion) {
  torso_servo_.move_to(height_m, motion);
}

bool MobileRobot::lift_allowed(double height_m) const {
  if (!torso_) return height_m == 0.0;
  const JointSpec& joint = world_.layout().sliders[*torso_];
  return height_m >= joint.low_m.value_or(height_m) && height_m <= joint.high_m.value_or(height_m);
}

Eigen::Vector3d MobileRobot::carried_to_world(const Eigen::Vector3d& p_B) const {
  return base_.to_world(p_B + lift_m() * Eigen::Vector3d::UnitZ());
}

bool MobileRobot::parked(const Arm& arm) const {
  return (arm.tool() - carry_point(arm)).norm() <= kParkedWithin_m;
}

AskedAcceleration MobileRobot::asked_acceleration(const Arm& arm) const {
  AskedAcceleration asked = base_.asked_acceleration(arm.tool());
  asked.level += arm.asked_acceleration();
  asked.upright += arm.asked_acceleration() + torso_servo_.asked_acceleration();
  return asked;
}

bool MobileRobot::open(const Arm& arm) const {
  return arm.opening_m() >= arm.spec().opening_m - kOpenWithin_m;
}

}  // namespace parallax::harness
