#include "harness/engine/jaws.h"

#include <algorithm>
#include <limits>

namespace parallax::harness {
namespace {

/// Half the extent of a box along a direction.
double half_extent(const Bounds& bounds, const Eigen::Vector3d& direction) {
  return 0.5 * direction.cwiseAbs().dot(bounds.high - bounds.low);
}

Eigen::Vector3d middle(const Bounds& bounds) { return 0.5 * (bounds.low + bounds.high); }

}  // namespace

Jaws::Jaws(const ArmSpec& spec, const PhysicsWorld& world) {
  const WorldLayout& layout = world.layout();
  const BodyId palm = *layout.find_body(spec.palm_body);
  const BodyId near_pad = *layout.find_body(spec.near_pad_body);
  const BodyId far_pad = *layout.find_body(spec.far_pad_body);
  const JointSpec& finger = layout.sliders[*layout.find_slider(spec.finger_joint)];
  const Eigen::Matrix3d R_PW = world.rotation(palm).transpose();
  const Bounds near = world.bounds(near_pad, layout.bodies[near_pad].shapes.front());
  const Bounds far = world.bounds(far_pad, layout.bodies[far_pad].shapes.front());
  const Eigen::Vector3d line = (middle(near) - middle(far)).normalized();
  pad_line_P_ = R_PW * line;
  tool_P_ = R_PW * (0.5 * (middle(near) + middle(far)) - world.position(palm));
  full_gap_m_ =
      (middle(near) - middle(far)).norm() - half_extent(near, line) - half_extent(far, line);
  closing_sign_ = finger.axis_W.normalized().dot(line) > 0.0 ? 1.0 : -1.0;

  constexpr double kNone = std::numeric_limits<double>::infinity();
  opening_limits_m_ = std::minmax(
      {opening_m(finger.low_m.value_or(-kNone)), opening_m(finger.high_m.value_or(kNone))});
}

}  // namespace parallax::harness
