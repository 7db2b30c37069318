#pragma once

#include <Eigen/Core>

#include "harness/engine/physics_world.h"

namespace parallax::harness {

/// Extent along a direction [m]: the middle, from the world's origin, and half the length.
struct AxisExtent {
  double middle_m = 0.0, half_m = 0.0;
};

/// Extent of one shape of a body, and of all of them, along a unit vector of any direction, as the
/// body stands now. Unlike the box round a body along the world's axes, it grows with no turn.
AxisExtent extent_along(const PhysicsWorld& world, BodyId body, const BodyShape& shape,
                        const Eigen::Vector3d& direction_W);
AxisExtent extent_along(const PhysicsWorld& world, BodyId body, const Eigen::Vector3d& direction_W);

}  // namespace parallax::harness
