#pragma once

#include <array>
#include <cstdint>

#include "harness/engine/physics_world.h"
#include "harness/robot/servo.h"

namespace parallax::harness {

enum class LineAxis : std::uint8_t { kBase, kReach, kLift, kFinger };

/// The robot of a world, seen as four driven axes and a pair of pads. Positions of axes are those
/// of their joints: 0 at the default placement.
class LineRobot {
 public:
  /// `spec.robot` names all roles.
  LineRobot(const WorldSpec& spec, PhysicsWorld& world);

  /// Brings all axes to rest where they are, with the force of their joints.
  void reset();

  void move_to(LineAxis axis, double target_m, const Motion& motion);
  void brake(LineAxis axis);
  void brake_all();
  /// Presses the driven pad towards the other one with `force_n`, until the next move of kFinger.
  void squeeze(double force_n, double speed_m_s, double acceleration_m_s2);

  /// The force of the squeeze that lasts [N]; 0: the fingers were opened, or never closed.
  double squeeze_n() const;
  /// The acceleration that the motion of an axis asks for [m/s2].
  double asked_acceleration(LineAxis axis) const { return drive(axis).servo.asked_acceleration(); }

  double position_m(LineAxis axis) const;
  bool at_rest(LineAxis axis) const { return drive(axis).servo.at_rest(); }
  /// The distance of `target_m` beyond the stops of the axis; 0 within them.
  double beyond_stops_m(LineAxis axis, double target_m) const;

  double base_x_m() const;
  /// The point half way between the pads, in the world [m].
  Eigen::Vector3d tool() const;
  /// Gap between the inner faces of the pads.
  double opening_m() const;
  /// Position of kFinger at which the gap is `opening_m`, within the stops.
  double finger_position_for(double opening_m) const;

  /// Sets the motors for the next timestep.
  void drive_motors();

 private:
  struct Drive {
    SliderId slider;
    double max_force_n = 0.0;  // of the joint, or the squeeze
    AxisServo servo;
  };
  Drive& drive(LineAxis axis) { return drives_[static_cast<std::size_t>(axis)]; }
  const Drive& drive(LineAxis axis) const { return drives_[static_cast<std::size_t>(axis)]; }
  const JointSpec& joint(LineAxis axis) const {
    return world_.layout().sliders[drive(axis).slider];
  }

  PhysicsWorld& world_;
  std::array<Drive, 4> drives_;
  BodyId base_, near_pad_, far_pad_;
  double open_gap_m_ = 0.0;    // at finger position 0
  double closing_sign_ = 1.0;  // of the finger velocity that narrows the gap
};

}  // namespace parallax::harness
