#pragma once

#include <array>

#include "harness/geometry_proof/proof_scene.h"

namespace parallax::harness {

/// Two boxes seen from above along one axis: how far the middle of the other is ahead, and the two
/// widths.
struct AxisView {
  AffineForm ahead;  // of the obstacle's middle
  AffineForm way;    // of the motion
  AffineForm width;  // half of both
  /// The room on this side (1 or -1) of a motion along the whole way.
  AffineForm gap(double side) const;
  /// The overlap once this share of the way is gone, on the less certain side.
  AffineForm overlap(double share) const;
};

/// The normals of both: they are apart if one of these axes tells them apart, and only then.
std::array<AxisView, 4> views_of(const UprightBox& part, const UprightBox& obstacle);
/// The same of a part that moves along a straight way; the last axis is the normal of the way,
/// divided by its length in the middle.
std::array<AxisView, 5> views_on_way(const UprightBox& part, const UprightBox& obstacle,
                                     const AffineForm& way_x, const AffineForm& way_y);

}  // namespace parallax::harness
