// Velocities for motors that bring an axis, a point on a line or a point on an arc to a target.
//
// The wanted speed is the one from which the motion can still stop at the target: far away
// sqrt(2 a d) as for constant deceleration a at distance d, nearby in proportion to the
// distance; the square root is shifted so that both meet in value and slope. The command follows
// it with bounded acceleration. Within the tolerance the axis brakes, and when it stands it
// holds its place by a proportional correction. A line is one such axis along its direction, an
// arc one over the angle turned; a bounded correction takes back what the point lies beside
// them. The nominal time is that of a trapezoid of speeds plus the exponential decay at the end.
//
// Cost: constant for each step.

#include "harness/robot/servo.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "harness/world/angles.h"

namespace parallax::harness {
namespace {

constexpr double kHoldRate_hz = 20.0;       // of the correction while keeping a place
constexpr double kMaxHoldSpeed_m_s = 0.05;  // of the same

constexpr double kSideRate_hz = 20.0;       // of the correction beside the line
constexpr double kMaxSideSpeed_m_s = 0.05;  // of the same
constexpr double kNoWay_m = 1e-9;

/// Speed from which `motion` can still stop at the target: constant deceleration far away, in
/// proportion to the distance nearby, where the two meet in value and slope.
double approach_speed(double distance_m, const Motion& motion) {
  const double rate = motion.approach_rate_hz;
  const double border_m = motion.acceleration_m_s2 / (rate * rate);
  if (distance_m <= border_m) return rate * distance_m;
  return std::sqrt(2.0 * motion.acceleration_m_s2 * (distance_m - 0.5 * border_m));
}

/// The velocity that takes back what a point lies beside its line [m/s].
Eigen::Vector3d back_to_line(const Eigen::Vector3d& beside) {
  const double distance = beside.norm();
  if (distance <= 0.0) return Eigen::Vector3d::Zero();
  return beside * (std::min(kSideRate_hz * distance, kMaxSideSpeed_m_s) / distance);
}

}  // namespace

double nominal_time_s(double distance_m, const Motion& motion) {
  const double d = std::abs(distance_m);
  const double v = motion.max_speed_m_s, a = motion.acceleration_m_s2;
  if (d <= motion.tolerance_m) return 0.0;
  const double trapezoid_s = d >= v * v / a ? d / v + v / a : 2.0 * std::sqrt(d / a);
  // The last part decays exponentially from the border of the proportional range.
  const double rate = motion.approach_rate_hz;
  const double start_m = std::min({d, a / (rate * rate), v / rate});
  return trapezoid_s + std::log(std::max(1.0, start_m / motion.tolerance_m)) / rate;
}

void AxisServo::reset(double position_m) {
  *this = AxisServo{};
  target_m_ = position_m;
}

void AxisServo::move_to(double target_m, const Motion& motion) {
  restart_ = mode_ == Mode::kPush;
  mode_ = Mode::kMove;
  motion_ = motion;
  target_m_ = target_m;
}

void AxisServo::brake() {
  if (mode_ == Mode::kHold) return;
  restart_ = mode_ == Mode::kPush;
  mode_ = Mode::kBrake;
}

void AxisServo::push(double velocity_m_s, double acceleration_m_s2) {
  mode_ = Mode::kPush;
  push_velocity_m_s_ = velocity_m_s;
  motion_.acceleration_m_s2 = acceleration_m_s2;
}

double AxisServo::wanted_velocity(double position_m) const {
  switch (mode_) {
    case Mode::kHold:
      return std::clamp(kHoldRate_hz * (target_m_ - position_m), -kMaxHoldSpeed_m_s,
                        kMaxHoldSpeed_m_s);
    case Mode::kBrake:
      return 0.0;
    case Mode::kMove: {
      const double error_m = target_m_ - position_m;
      const double speed =
          std::min(motion_.max_speed_m_s, approach_speed(std::abs(error_m), motion_));
      return std::copysign(speed, error_m);
    }
    case Mode::kPush:
      return push_velocity_m_s_;
  }
  return 0.0;
}

double AxisServo::next_velocity(double position_m, double rate_m_s, double timestep_s) {
  if (restart_) command_m_s_ = rate_m_s;  // a saturated push says nothing of the real velocity
  restart_ = false;
  if (mode_ == Mode::kMove && std::abs(target_m_ - position_m) <= motion_.tolerance_m) {
    mode_ = Mode::kBrake;
  }
  const double change = motion_.acceleration_m_s2 * timestep_s;
  command_m_s_ =
      std::clamp(wanted_velocity(position_m), command_m_s_ - change, command_m_s_ + change);
  if (mode_ == Mode::kBrake && command_m_s_ == 0.0) {
    mode_ = Mode::kHold;
    target_m_ = position_m;
  }
  return command_m_s_;
}

void LineServo::reset(const Eigen::Vector3d& position) {
  start_ = position;
  direction_ = Eigen::Vector3d::UnitX();
  along_.reset(0.0);
}

void LineServo::move_to(const Eigen::Vector3d& position, const Eigen::Vector3d& target,
                        const Motion& motion) {
  const Eigen::Vector3d way = target - position;
  start_ = position;
  along_.reset(0.0);
  if (way.norm() < kNoWay_m) return;
  direction_ = way.normalized();
  along_.move_to(way.norm(), motion);
}

Eigen::Vector3d LineServo::next_velocity(const Eigen::Vector3d& position, double timestep_s) {
  const double s = direction_.dot(position - start_);
  const double speed = along_.next_velocity(s, 0.0, timestep_s);
  const Eigen::Vector3d beside = start_ + s * direction_ - position;
  return speed * direction_ + back_to_line(beside);
}

void ArcServo::move_round(const Eigen::Vector3d& position, const Eigen::Vector3d& centre,
                          double angle_rad, const Motion& motion) {
  centre_ = centre;
  start_ = position - centre;
  turned_rad_ = rate_rad_s_ = 0.0;
  along_.reset(0.0);
  along_.move_to(angle_rad, motion);
}

Eigen::Vector3d ArcServo::next_velocity(const Eigen::Vector3d& position, double timestep_s) {
  const Eigen::Vector3d from_centre = position - centre_;
  const double now_rad = std::atan2(from_centre.y(), from_centre.x());
  const double start_rad = std::atan2(start_.y(), start_.x());
  turned_rad_ += wrapped(now_rad - start_rad - turned_rad_);
  rate_rad_s_ = along_.next_velocity(turned_rad_, 0.0, timestep_s);
  const double radius_m = start_.head<2>().norm();
  const Eigen::Vector3d outwards(std::cos(now_rad), std::sin(now_rad), 0.0);
  const Eigen::Vector3d on_circle = radius_m * outwards + start_.z() * Eigen::Vector3d::UnitZ();
  return rate_rad_s_ * radius_m * Eigen::Vector3d::UnitZ().cross(outwards) +
         back_to_line(on_circle - from_centre);
}

}  // namespace parallax::harness
