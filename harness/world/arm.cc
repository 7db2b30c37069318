#include "harness/world/arm.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "harness/world/mobile_base.h"

namespace parallax::harness {
namespace {

constexpr double kFingerAcceleration_m_s2 = 0.5;

/// Half the extent of a box along a direction.
double half_extent(const Bounds& bounds, const Eigen::Vector3d& direction) {
  return 0.5 * direction.cwiseAbs().dot(bounds.high - bounds.low);
}

Eigen::Vector3d middle(const Bounds& bounds) { return 0.5 * (bounds.low + bounds.high); }

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
      near_pad_(*world.layout().find_body(spec.near_pad_body)),
      far_pad_(*world.layout().find_body(spec.far_pad_body)),
      bodies_(linked_with(world.layout(), {palm_, far_pad_})) {
  // The world is fresh, hence at its default placement, the robot heading along its own x.
  const Eigen::Matrix3d R_PW = world.rotation(palm_).transpose();
  const Bounds near = world.bounds(near_pad_, world.layout().bodies[near_pad_].shapes.front());
  const Bounds far = world.bounds(far_pad_, world.layout().bodies[far_pad_].shapes.front());
  const Eigen::Vector3d line = (middle(near) - middle(far)).normalized();
  pad_line_P_ = R_PW * line;
  tool_P_ = R_PW * (0.5 * (middle(near) + middle(far)) - world.position(palm_));
  full_gap_m_ =
      (middle(near) - middle(far)).norm() - half_extent(near, line) - half_extent(far, line);
  const Eigen::Vector3d axis = world.layout().sliders[finger_joint_].axis_W.normalized();
  closed_sign_ = axis.dot(line) > 0.0 ? 1.0 : -1.0;
}

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
  const double wanted = closed_sign_ * (full_gap_m_ - opening_m);
  finger_force_n_ = joint.max_force_n;
  finger_.move_to(std::clamp(wanted, joint.low_m.value_or(wanted), joint.high_m.value_or(wanted)),
                  motion);
}

void Arm::squeeze(double force_n, double speed_m_s) {
  finger_force_n_ = force_n;
  finger_.push(closed_sign_ * speed_m_s, kFingerAcceleration_m_s2);
}

void Arm::brake() {
  // A closed gripper keeps squeezing: an action cut short does not drop what is held.
  line_.brake();
  wrist_.brake();
}

Eigen::Vector3d Arm::tool() const {
  return world_.position(palm_) + world_.rotation(palm_) * tool_P_;
}

double Arm::opening_m() const {
  return full_gap_m_ - closed_sign_ * world_.slider_position_m(finger_joint_);
}

std::pair<double, double> Arm::opening_limits_m() const {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const JointSpec& joint = world_.layout().sliders[finger_joint_];
  const double one = full_gap_m_ - closed_sign_ * joint.low_m.value_or(-kNone);
  const double other = full_gap_m_ - closed_sign_ * joint.high_m.value_or(kNone);
  return std::minmax({one, other});
}

double Arm::wrist_rad() const { return world_.gantry_yaw_rad(gantry_); }

Eigen::Vector3d Arm::pad_line() const { return world_.rotation(palm_) * pad_line_P_; }

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
