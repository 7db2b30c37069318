#pragma once

#include <Eigen/Core>
#include <utility>

#include "harness/world/world_spec.h"

namespace parallax::harness {

/// R_BS (3 x 3).
Eigen::Matrix3d shape_rotation(const BodyShape& shape);

double volume_m3(const BodyShape& shape);

/// The centre of mass of an evenly filled shape in the frame of the body [m].
Eigen::Vector3d centroid_B(const BodyShape& shape);

/// Lowest and highest coordinates, from the shape's place on, of something that R turns. `hull` is
/// null but for hulls.
std::pair<Eigen::Vector3d, Eigen::Vector3d> span(ShapeForm form, const Eigen::Vector3d& size_m,
                                                 const ConvexHull* hull, const Eigen::Matrix3d& R);

/// Half of the sides of the axis-aligned box round something of this form and size that R turns;
/// of a hull, round its box.
Eigen::Vector3d half_extents(ShapeForm form, const Eigen::Vector3d& size_m,
                             const Eigen::Matrix3d& R);

/// Is the point, in the frame of the body, in the shape?
bool contains(const BodyShape& shape, const Eigen::Vector3d& p_B);

/// A box whose z axis is that of the body.
inline bool is_upright_box(const BodyShape& shape) {
  return shape.form == ShapeForm::kBox && shape.roll_rad == 0.0 && shape.pitch_rad == 0.0;
}

/// Sides of the box round a sphere, a cylinder or a capsule. The length of a capsule is without its
/// caps, that of a sphere is of no account.
Eigen::Vector3d round_size_m(ShapeForm form, double radius_m, double length_m);

/// Eigenvalues of a symmetric matrix, ascending, in closed form (Smith, Communications of the ACM
/// 4(4), 1961).
Eigen::Vector3d principal_moments(const Eigen::Matrix3d& I);

}  // namespace parallax::harness
