#include "harness/robot/arm.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <initializer_list>
#include <utility>

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

std::variant<PalmGantry, PalmChain> carrier_of(const WorldSpec& world_spec, const ArmSpec& spec,
                                               PhysicsWorld& world) {
  if (spec.chain.empty()) return PalmGantry(spec, world);
  return PalmChain(world_spec, spec, world);
}

}  // namespace

Arm::Arm(const WorldSpec& world_spec, const ArmSpec& spec, std::uint32_t gripper,
         PhysicsWorld& world)
    : spec_(spec),
      gripper_(gripper),
      world_(world),
      carrier_(carrier_of(world_spec, spec, world)),
      finger_joint_(*world.layout().find_slider(spec.finger_joint)),
      palm_(*world.layout().find_body(spec.palm_body)),
      jaws_(spec, world),
      bodies_(linked_with(world.layout(), {palm_, *world.layout().find_body(spec.near_pad_body),
                                           *world.layout().find_body(spec.far_pad_body)})) {}

void Arm::reset() {
  std::visit([](auto& carrier) { carrier.reset(); }, carrier_);
  finger_.reset(world_.slider_position_m(finger_joint_));
  finger_force_n_ = world_.layout().sliders[finger_joint_].max_force_n;
}

void Arm::move_tool_to(const Eigen::Vector3d& target_W, const Motion& motion) {
  if (auto* gantry = std::get_if<PalmGantry>(&carrier_)) {
    gantry->lead_to(tool(), target_W, motion);
  } else {
    std::get<PalmChain>(carrier_).lead_to(target_W, motion);
  }
}

void Arm::lead_tool_round(const Eigen::Vector3d& centre_W, double angle_rad, const Motion& motion) {
  if (auto* gantry = std::get_if<PalmGantry>(&carrier_)) {
    gantry->lead_round(tool(), centre_W, angle_rad, motion);
  } else {
    std::get<PalmChain>(carrier_).lead_round(centre_W, angle_rad, motion);
  }
}

void Arm::turn_wrist_to(double yaw_rad, const Motion& motion) {
  std::visit([&](auto& carrier) { carrier.turn_to(yaw_rad, motion); }, carrier_);
}

void Arm::swing_along(ChainWay way, const Motion& motion) {
  std::get<PalmChain>(carrier_).swing_along(std::move(way), motion);
}

void Arm::open_to(double opening_m, const Motion& motion) {
  const JointSpec& joint = world_.layout().sliders[finger_joint_];
  const double wanted = jaws_.finger_m(opening_m);
  finger_force_n_ = joint.max_force_n;
  finger_.move_to(std::clamp(wanted, joint.low_m.value_or(wanted), joint.high_m.value_or(wanted)),
                  motion);
}

void Arm::squeeze(double force_n, double speed_m_s) {
  finger_force_n_ = force_n * jaws_.gain();
  finger_.push(jaws_.closing_sign() * speed_m_s, kFingerAcceleration_m_s2);
}

void Arm::brake() {
  // A closed gripper keeps squeezing: an action cut short does not drop what is held.
  std::visit([](auto& carrier) { carrier.brake(); }, carrier_);
}

bool Arm::tool_at_rest() const {
  return std::visit([](const auto& carrier) { return carrier.at_rest(); }, carrier_);
}

double Arm::asked_acceleration() const {
  return std::visit([](const auto& carrier) { return carrier.asked_acceleration(); }, carrier_);
}

Eigen::Vector3d Arm::tool() const {
  return world_.position(palm_) + world_.rotation(palm_) * jaws_.tool_P();
}

double Arm::opening_m() const { return jaws_.opening_m(world_.slider_position_m(finger_joint_)); }

double Arm::wrist_rad() const {
  return std::visit([](const auto& carrier) { return carrier.wrist_rad(); }, carrier_);
}

double Arm::wrist_goal_rad() const {
  const auto* chain = std::get_if<PalmChain>(&carrier_);
  return chain != nullptr ? chain->wrist_goal_rad() : wrist_rad();
}

void Arm::aim_wrist(double yaw_rad) {
  if (auto* chain = std::get_if<PalmChain>(&carrier_)) chain->aim_wrist(yaw_rad);
}

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
  std::visit([](auto& carrier) { carrier.drive_motors(); }, carrier_);
  const double finger =
      finger_.next_velocity(world_.slider_position_m(finger_joint_),
                            world_.slider_rate_m_s(finger_joint_), world_.timestep_s());
  world_.set_motor(finger_joint_, finger, finger_force_n_);
}

}  // namespace parallax::harness
