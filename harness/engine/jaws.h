#pragma once

#include <Eigen/Core>
#include <utility>

#include "harness/engine/physics_world.h"

namespace parallax::harness {

/// The pads of an arm's gripper against its palm and its finger, as the world stands by default.
/// Frame P is that of the palm.
class Jaws {
 public:
  /// `world` is fresh: nothing has moved since it was made.
  Jaws(const ArmSpec& spec, const PhysicsWorld& world);

  const Eigen::Vector3d& tool_P() const { return tool_P_; }  // the middle between the pads [m]
  /// Unit vector along the way of the finger, from the far pad to the near one.
  const Eigen::Vector3d& pad_line_P() const { return pad_line_P_; }
  /// Sign of the way of the finger that narrows the gap.
  double closing_sign() const { return closing_sign_; }
  /// Gap between the pads' inner faces at this position of the finger's joint, and the reverse.
  double opening_m(double finger_m) const { return full_gap_m_ - closing_sign_ * gain_ * finger_m; }
  double finger_m(double opening_m) const {
    return closing_sign_ * (full_gap_m_ - opening_m) / gain_;
  }
  /// The force of the finger's motor for each newton of squeeze.
  double gain() const { return gain_; }
  /// The narrowest and the widest opening that the stops of the finger allow.
  std::pair<double, double> opening_limits_m() const { return opening_limits_m_; }

 private:
  Eigen::Vector3d tool_P_, pad_line_P_;
  double closing_sign_ = 1.0, gain_ = 1.0;
  double full_gap_m_ = 0.0;  // at finger position 0
  std::pair<double, double> opening_limits_m_;
};

}  // namespace parallax::harness
