#include "harness/robot/mobile_base.h"

#include <cmath>
#include <numbers>

namespace parallax::harness {
namespace {

Eigen::Vector3d level(const Eigen::Vector2d& p) { return {p.x(), p.y(), 0.0}; }

}  // namespace

double wrapped(double angle_rad) { return std::atan2(std::sin(angle_rad), std::cos(angle_rad)); }

MobileBase::MobileBase(const MobileRobotSpec& spec, OdeWorld& world)
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
  return {world_.position(body_).head<2>(), std::atan2(R(1, 0), R(0, 0))};
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

}  // namespace parallax::harness
