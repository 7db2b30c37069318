#include "harness/engine/jaws.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "harness/world/shapes.h"

namespace parallax::harness {
namespace {

/// Half the extent of a pad's shape along a direction. The box round it along the axes of the world
/// is as long as the shape only along these.
double half_extent(const PhysicsWorld& world, BodyId pad, const BodyShape& shape,
                   const Eigen::Vector3d& direction) {
  const Bounds bounds = world.bounds(pad, shape);
  if (direction.cwiseAbs().maxCoeff() > 1.0 - 1e-12) {
    return 0.5 * direction.cwiseAbs().dot(bounds.high - bounds.low);
  }
  const Eigen::Matrix3d R_DW =
      Eigen::Quaterniond::FromTwoVectors(direction, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const auto [low, high] = span(shape.form, shape.size_m, shape.hull.get(),
                                R_DW * world.rotation(pad) * shape_rotation(shape));
  return 0.5 * (high.x() - low.x());
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
  const BodyShape& near_shape = layout.bodies[near_pad].shapes.front();
  const BodyShape& far_shape = layout.bodies[far_pad].shapes.front();
  const Bounds near = world.bounds(near_pad, near_shape);
  const Bounds far = world.bounds(far_pad, far_shape);
  const Eigen::Vector3d line = (middle(near) - middle(far)).normalized();
  pad_line_P_ = R_PW * line;
  tool_P_ = R_PW * (0.5 * (middle(near) + middle(far)) - world.position(palm));
  full_gap_m_ = (middle(near) - middle(far)).norm() -
                half_extent(world, near_pad, near_shape, line) -
                half_extent(world, far_pad, far_shape, line);
  closing_sign_ = finger.axis_W.normalized().dot(line) > 0.0 ? 1.0 : -1.0;

  constexpr double kNone = std::numeric_limits<double>::infinity();
  opening_limits_m_ = std::minmax(
      {opening_m(finger.low_m.value_or(-kNone)), opening_m(finger.high_m.value_or(kNone))});
}

}  // namespace parallax::harness
