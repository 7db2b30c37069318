#include "harness/robot/mobile_robot.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "harness/world/angles.h"

namespace parallax::harness {
namespace {

constexpr double kFingerAcceleration_m_s2 = 0.5;

/// The bodies of the links that `roots` belong to.
std::vector<BodyId> linked_with(const WorldLayout& layout, std::initializer_list<BodyId> roots) {
  std::vector<BodyId> all;
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    const bool moves = std::any_of(roots.begin(), roots.end(), [&](BodyId root) {
      return layout.link_of[i].has_value() && layout.link_of[i] == layout.link_of[root.index()];
    });
    if (moves) all.push_back(layout.bodies.id_at(i));
  }
  return all;
}

constexpr double kOpenWithin_m = 0.01;

Eigen::Vector3d level(const Eigen::Vector2d& p) { return {p.x(), p.y(), 0.0}; }

}  // namespace

Arm::Arm(const ArmSpec& spec, std::uint32_t gripper, PhysicsWorld& world)
    : spec_(spec),
      gripper_(gripper),
      world_(world),
      gantry_(*world.layout().find_gantry(spec.joint)),
      finger_joint_(*world.layout().find_slider(spec.finger_joint)),
      palm_(*world.layout().find_body(spec.palm_body)),
      jaws_(spec, world),
      bodies_(linked_with(world.layout(), {palm_, *world.layout().find_body(spec.far_pad_body)})) {}

void Arm::reset() {
  line_.reset(world_.gantry_position_m(gantry_));
  wrist_unwrapped_rad_ = world_.gantry_yaw_rad(gantry_);
  wrist_.reset(wrist_unwrapped_rad_);
  finger_.reset(world_.slider_position_m(finger_joint_));
  finger_force_n_ = world_.layout().sliders[finger_joint_].max_force_n;
}

void Arm::move_tool_to(const Eigen::Vector3d& target_W, const Motion& motion) {
  const JointSpec& joint = world_.layout().gantries[gantry_];
  const BodyId parent = *world_.layout().find_body(joint.parent);
  const Eigen::Vector3d now = world_.gantry_position_m(gantry_);
  line_.move_to(now, now + world_.rotation(parent).transpose() * (target_W - tool()), motion);
}

void Arm::turn_wrist_to(double yaw_rad, const Motion& motion) {
  wrist_.move_to(wrist_unwrapped_rad_ + wrapped(yaw_rad - wrist_unwrapped_rad_), motion);
}

void Arm::open_to(double opening_m, const Motion& motion) {
  const JointSpec& joint = world_.layout().sliders[finger_joint_];
  const double wanted = jaws_.finger_m(opening_m);
  finger_force_n_ = joint.max_force_n;
  finger_.move_to(std::clamp(wanted, joint.low_m.value_or(wanted), joint.high_m.value_or(wanted)),
                  motion);
}

void Arm::squeeze(double force_n, double speed_m_s) {
  finger_force_n_ = force_n;
  finger_.push(jaws_.closing_sign() * speed_m_s, kFingerAcceleration_m_s2);
}

void Arm::brake() {
  // A closed gripper keeps squeezing: an action cut short does not drop what is held.
  line_.brake();
  wrist_.brake();
}

Eigen::Vector3d Arm::tool() const {
  return world_.position(palm_) + world_.rotation(palm_) * jaws_.tool_P();
}

double Arm::opening_m() const { return jaws_.opening_m(world_.slider_position_m(finger_joint_)); }

double Arm::wrist_rad() const { return world_.gantry_yaw_rad(gantry_); }

Eigen::Vector3d Arm::pad_line(double wrist_rad) const {
  const Eigen::Vector3d now = world_.rotation(palm_) * jaws_.pad_line_P();
  return Eigen::AngleAxisd(wrist_rad - this->wrist_rad(), Eigen::Vector3d::UnitZ()) * now;
}

Eigen::Vector3d Arm::palm_offset() const { return world_.position(palm_) - tool(); }

double Arm::palm_half_extent_m(const Eigen::Vector3d& direction_W, double wrist_rad) const {
  const Eigen::AngleAxisd turn_back(this->wrist_rad() - wrist_rad, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d direction_P =
      world_.rotation(palm_).transpose() * (turn_back * direction_W);
  const Eigen::Vector3d& size_m = world_.layout().bodies[palm_].shapes.front().size_m;
  return 0.5 * direction_P.cwiseAbs().dot(size_m);
}

void Arm::drive_motors() {
  const double step_s = world_.timestep_s();
  wrist_unwrapped_rad_ += wrapped(world_.gantry_yaw_rad(gantry_) - wrist_unwrapped_rad_);
  const Eigen::Vector3d velocity = line_.next_velocity(world_.gantry_position_m(gantry_), step_s);
  world_.set_gantry(gantry_, velocity, wrist_.next_velocity(wrist_unwrapped_rad_, 0.0, step_s));
  const double finger = finger_.next_velocity(world_.slider_position_m(finger_joint_),
                                              world_.slider_rate_m_s(finger_joint_), step_s);
  world_.set_motor(finger_joint_, finger, finger_force_n_);
}

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
  for (const ArmSpec& arm : spec_.arms) arms_.emplace_back(arm, gripper++, world);
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

bool MobileRobot::open(const Arm& arm) const {
  return arm.opening_m() >= arm.spec().opening_m - kOpenWithin_m;
}

}  // namespace parallax::harness
