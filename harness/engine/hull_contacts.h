#pragma once

#include <Eigen/Core>
#include <vector>

#include "harness/engine/box_contacts.h"
#include "harness/world/convex_hull.h"

namespace parallax::harness {

/// A convex polyhedron in its place.
struct Polyhedron {
  std::vector<Eigen::Vector3d> corners_W, normals_W;  // normals outwards
  std::vector<double> offsets;                        // of the planes: normal * p [m]
};

Polyhedron placed_hull(const ConvexHull& hull, const Eigen::Vector3d& p_W,
                       const Eigen::Matrix3d& R_W);
Polyhedron placed_box(const PlacedBox& box);

/// The contacts of a face of one of two overlapping polyhedra with the other, as with boxes: at
/// corners of their common part, the deepest and then those farthest apart. None where no face
/// overlaps as little as the known depth `depth_m` along `normal_W`, give or take a tenth: there
/// they touch by edges.
BoxContacts hull_contacts(const Polyhedron& first, const Polyhedron& second,
                          const Eigen::Vector3d& normal_W, double depth_m);

}  // namespace parallax::harness
