#include "harness/robot/arm.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

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

}  // namespace

Arm::Arm(const ArmSpec& spec, std::uint32_t gripper, OdeWorld& world)
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

}  // namespace parallax::harness
