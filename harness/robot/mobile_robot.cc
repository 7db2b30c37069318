#include "harness/robot/mobile_robot.h"

#include <algorithm>

namespace parallax::harness {
namespace {

constexpr double kParkedWithin_m = 0.03;
constexpr double kOpenWithin_m = 0.01;

}  // namespace

MobileRobot::MobileRobot(const WorldSpec& spec, OdeWorld& world)
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
