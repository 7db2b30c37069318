#include "harness/robot/line_servo.h"

#include <algorithm>

namespace parallax::harness {
namespace {

constexpr double kSideRate_hz = 20.0;       // of the correction beside the line
constexpr double kMaxSideSpeed_m_s = 0.05;  // of the same
constexpr double kNoWay_m = 1e-9;

}  // namespace

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
  const double distance = beside.norm();
  const double correction = std::min(kSideRate_hz * distance, kMaxSideSpeed_m_s);
  Eigen::Vector3d velocity = speed * direction_;
  if (distance > 0.0) velocity += beside * (correction / distance);
  return velocity;
}

}  // namespace parallax::harness
