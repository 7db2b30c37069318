#pragma once

#include <Eigen/Core>
#include <optional>

#include "harness/world/world_spec.h"

namespace parallax::harness {

/// Distance [m] at which a ray of unit direction enters a shape, or leaves it if it begins inside.
/// All is in the shape's own frame. `hull` is null but for hulls.
std::optional<double> ray_meets_shape(ShapeForm form, const Eigen::Vector3d& size_m,
                                      const ConvexHull* hull, const Eigen::Vector3d& from_S,
                                      const Eigen::Vector3d& direction_S);

}  // namespace parallax::harness
