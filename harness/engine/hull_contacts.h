#pragma once

#include <Eigen/Core>
#include <vector>

#include "harness/engine/box_contacts.h"
#include "harness/world/convex_hull.h"

namespace parallax::harness {

/// Something convex with flat faces, where it is.
struct Polyhedron {
  std::vector<Eigen::Vector3d> corners_W, normals_W;  // normals outwards
  std::vector<double> offsets;                        // of the planes: normal * p [m]
};

Polyhedron placed_hull(const ConvexHull& hull, const Eigen::Vector3d& p_W,
                       const Eigen::Matrix3d& R_W);
Polyhedron placed_box(const PlacedBox& box);

/// Where a face of one of two polyhedra that overlap lies on the other, as with boxes: at corners
/// of what they share, the deepest and then those farthest apart. None where no face overlaps as
/// little as `depth_m` along `normal_W`, that somebody has found, but for a tenth: they touch by
/// edges there.
BoxContacts hull_contacts(const Polyhedron& first, const Polyhedron& second,
                          const Eigen::Vector3d& normal_W, double depth_m);

}  // namespace parallax::harness
