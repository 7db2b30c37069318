#include "harness/engine/extent_along.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "harness/world/shapes.h"

namespace parallax::harness {
namespace {

bool is_axis_of_world(const Eigen::Vector3d& direction) {
  return direction.cwiseAbs().maxCoeff() > 1.0 - 1e-12;
}

AxisExtent extent_of_box(const BodyBounds& box, const Eigen::Vector3d& direction) {
  return {direction.dot(0.5 * (box.low + box.high)),
          0.5 * direction.cwiseAbs().dot(box.high - box.low)};
}

}  // namespace

AxisExtent extent_along(const PhysicsWorld& world, BodyId body, const BodyShape& shape,
                        const Eigen::Vector3d& direction_W) {
  AxisExtent extent = extent_of_box(world.bounds(body, shape), direction_W);
  if (is_axis_of_world(direction_W)) return extent;
  const Eigen::Matrix3d R_DW =
      Eigen::Quaterniond::FromTwoVectors(direction_W, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const auto [low, high] = span(shape.form, shape.size_m, shape.hull.get(),
                                R_DW * world.rotation(body) * shape_rotation(shape));
  const Eigen::Vector3d origin_W = world.position(body) + world.rotation(body) * shape.p_BS;
  extent.middle_m = direction_W.dot(origin_W) + 0.5 * (low.x() + high.x());
  extent.half_m = 0.5 * (high.x() - low.x());
  return extent;
}

AxisExtent extent_along(const PhysicsWorld& world, BodyId body,
                        const Eigen::Vector3d& direction_W) {
  if (is_axis_of_world(direction_W)) return extent_of_box(world.bounds(body), direction_W);
  double low_m = std::numeric_limits<double>::infinity(), high_m = -low_m;
  for (const BodyShape& shape : world.layout().bodies[body].shapes) {
    const AxisExtent one = extent_along(world, body, shape, direction_W);
    low_m = std::min(low_m, one.middle_m - one.half_m);
    high_m = std::max(high_m, one.middle_m + one.half_m);
  }
  return {0.5 * (low_m + high_m), 0.5 * (high_m - low_m)};
}

}  // namespace parallax::harness
