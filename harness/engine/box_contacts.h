#pragma once

#include <Eigen/Core>
#include <array>

namespace parallax::harness {

/// A box by its middle, its half sides and its axes (the columns).
struct PlacedBox {
  Eigen::Vector3d p_W, half_m;
  Eigen::Matrix3d R_WB;
};

struct BoxContact {
  Eigen::Vector3d p_W;  // midway between the two surfaces
  double depth_m = 0.0;
};

/// The contacts of two boxes. Two faces touch at the corners of their common part, eight at most;
/// two edges that cross touch at a point.
struct BoxContacts {
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();  // from the first to the second, unit
  std::array<BoxContact, 8> points;
  int count = 0;
};

/// None where an axis parts them. Otherwise along the axis of the least overlap: by theorem it is
/// the normal of a face or is across two edges (Gottschalk, Lin and Manocha, SIGGRAPH 1996). Where
/// edges overlap a little less than a face, but the face has points that are as deep, the face is
/// taken: a box that was laid flat on another but for a rounding stands on its corners and not on
/// one point.
BoxContacts contacts_of(const PlacedBox& first, const PlacedBox& second);

}  // namespace parallax::harness
