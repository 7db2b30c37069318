#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

namespace parallax::harness {

/// How an axis is to move. The speed follows a trapezoid over time and falls in proportion to the
/// distance near the target; the command never jumps, because a velocity step shakes what the
/// gripper holds by a force that depends on the timestep.
struct Motion {
  double max_speed_m_s = 0.25;
  double acceleration_m_s2 = 0.5;
  /// The servo brakes as soon as it is this near, and stays where it comes to rest: what is left
  /// is its honest positioning error, on the side it came from.
  double tolerance_m = 0.001;
  double approach_rate_hz = 6.0;  // speed per distance close to the target
};

/// Time [s] that `motion` takes for `distance_m` if nothing is in the way.
double nominal_time_s(double distance_m, const Motion& motion);

/// Velocity command of one driven axis, advanced once per timestep.
class AxisServo {
 public:
  /// Comes to rest at `position_m` at once, and keeps it.
  void reset(double position_m);
  void move_to(double target_m, const Motion& motion);
  /// Comes to rest with the acceleration of the last motion and keeps the place reached.
  void brake();
  /// Ramps to a velocity and keeps pushing, force permitting.
  void push(double velocity_m_s, double acceleration_m_s2);

  /// The command for the next timestep, from the measured position and rate of the axis.
  double next_velocity(double position_m, double rate_m_s, double timestep_s);

  /// Is the last motion or braking over?
  bool at_rest() const { return mode_ == Mode::kHold; }
  bool is_pushing() const { return mode_ == Mode::kPush; }
  /// The rate at which its velocity may change; 0 at rest.
  double asked_acceleration() const { return at_rest() ? 0.0 : motion_.acceleration_m_s2; }
  /// The last command.
  double asked_velocity() const { return command_m_s_; }

 private:
  enum class Mode : std::uint8_t { kHold, kBrake, kMove, kPush };
  double wanted_velocity(double position_m) const;

  Mode mode_ = Mode::kHold;
  bool restart_ = false;  // the next ramp begins at the measured rate
  Motion motion_;
  double target_m_ = 0.0;  // kMove: the goal; kHold: the place to keep
  double push_velocity_m_s_ = 0.0;
  double command_m_s_ = 0.0;
};

/// Velocity command of a point that is to move along straight lines, advanced once per timestep.
/// The way along the line is an AxisServo's; what lies beside the line is taken back in proportion.
class LineServo {
 public:
  /// Comes to rest at `position` at once, and keeps it.
  void reset(const Eigen::Vector3d& position);
  /// Moves straight from the measured position to `target`.
  void move_to(const Eigen::Vector3d& position, const Eigen::Vector3d& target,
               const Motion& motion);
  void brake() { along_.brake(); }
  Eigen::Vector3d next_velocity(const Eigen::Vector3d& position, double timestep_s);
  bool at_rest() const { return along_.at_rest(); }
  double asked_acceleration() const { return along_.asked_acceleration(); }
  double asked_speed() const { return std::abs(along_.asked_velocity()); }

 private:
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction_ = Eigen::Vector3d::UnitX();
  AxisServo along_;
};

/// Velocity command of a point that is to move on a circle about the vertical through a centre,
/// advanced once per timestep. The way along the circle is an AxisServo's, in radians; what lies
/// beside it is taken back in proportion.
class ArcServo {
 public:
  /// Moves from the measured position by `angle_rad` round `centre`, at its height; `motion` is in
  /// radians.
  void move_round(const Eigen::Vector3d& position, const Eigen::Vector3d& centre, double angle_rad,
                  const Motion& motion);
  void brake() { along_.brake(); }
  Eigen::Vector3d next_velocity(const Eigen::Vector3d& position, double timestep_s);
  bool at_rest() const { return along_.at_rest(); }
  /// The angle turned since the motion began, and the commanded rate; by the last command.
  double turned_rad() const { return turned_rad_; }
  double rate_rad_s() const { return rate_rad_s_; }
  /// The acceleration of the point, along the circle and towards its centre added up.
  double asked_acceleration() const {
    return start_.head<2>().norm() * (along_.asked_acceleration() + rate_rad_s_ * rate_rad_s_);
  }

 private:
  Eigen::Vector3d start_ = Eigen::Vector3d::UnitX();  // from the centre
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  double turned_rad_ = 0.0, rate_rad_s_ = 0.0;
  AxisServo along_;
};

}  // namespace parallax::harness
