#include "harness/engine/jaws.h"

#include <algorithm>
#include <limits>

#include "harness/engine/extent_along.h"

namespace parallax::harness {
namespace {

Eigen::Vector3d middle(const BodyBounds& bounds) { return 0.5 * (bounds.low + bounds.high); }

}  // namespace

Jaws::Jaws(const ArmSpec& spec, const PhysicsWorld& world) {
  const WorldLayout& layout = world.layout();
  const BodyId palm = *layout.find_body(spec.palm_body);
  const BodyId near_pad = *layout.find_body(spec.near_pad_body);
  const BodyId far_pad = *layout.find_body(spec.far_pad_body);
  const JointSpec& finger = layout.sliders[*layout.find_slider(spec.finger_joint)];
  const Eigen::Matrix3d R_PW = world.rotation(palm).transpose();
  const BodyShape& near_shape = layout.bodies[near_pad].shapes.front();
  const BodyShape& far_shape = layout.bodies[far_pad].shapes.front();
  const BodyBounds near = world.bounds(near_pad, near_shape);
  const BodyBounds far = world.bounds(far_pad, far_shape);
  // The gap lies along the way of the finger, whatever else the pads are beside each other.
  const Eigen::Vector3d axis = finger.axis_W.normalized();
  closing_sign_ = axis.dot(middle(near) - middle(far)) > 0.0 ? 1.0 : -1.0;
  const Eigen::Vector3d line = closing_sign_ * axis;
  pad_line_P_ = R_PW * line;
  tool_P_ = R_PW * (0.5 * (middle(near) + middle(far)) - world.position(palm));
  full_gap_m_ = line.dot(middle(near) - middle(far)) -
                extent_along(world, near_pad, near_shape, line).half_m -
                extent_along(world, far_pad, far_shape, line).half_m;
  gain_ = grip_gain(layout, spec.finger_joint, spec.near_pad_body);

  constexpr double kNone = std::numeric_limits<double>::infinity();
  opening_limits_m_ = std::minmax(
      {opening_m(finger.low_m.value_or(-kNone)), opening_m(finger.high_m.value_or(kNone))});
}

}  // namespace parallax::harness
