// Two upright boxes seen along axes of the plane, as functions of the start (affine_form.cc).
//
// Two rectangles are apart exactly if they are along the normal of one of their four sides
// (separating axes). Along each of them the view gives the distance of the middles and the sum
// of the half widths: their difference is a gap, and where it is positive for a whole box of
// starts, the shapes are apart there. A part that is swept along a straight way is the hull of
// its two ends, so its gap is the lesser one of both, and the normal of the way is a fifth axis.

#include "harness/geometry_proof/axis_views.h"

#include <algorithm>
#include <cmath>

namespace parallax::harness {
namespace {

/// Unit vectors as functions of the start.
struct Direction {
  AffineForm x, y;
};

AffineForm dot(const Direction& a, const AffineForm& x, const AffineForm& y) {
  return a.x * x + a.y * y;
}

/// Half the width of a box seen along `n`.
AffineForm half_width(const UprightBox& box, const Direction& n) {
  const AffineForm along = absolute(n.x * box.cosine + n.y * box.sine);
  const AffineForm across = absolute(n.y * box.cosine - n.x * box.sine);
  return along * AffineForm(box.half_x) + across * AffineForm(box.half_y);
}

std::array<Direction, 4> normals_of(const UprightBox& part, const UprightBox& obstacle) {
  return {Direction{part.cosine, part.sine}, Direction{-part.sine, part.cosine},
          Direction{obstacle.cosine, obstacle.sine}, Direction{-obstacle.sine, obstacle.cosine}};
}

AxisView view_along(const Direction& axis, const UprightBox& part, const UprightBox& obstacle) {
  return {dot(axis, obstacle.x - part.x, obstacle.y - part.y), AffineForm(0.0),
          half_width(part, axis) + half_width(obstacle, axis)};
}

}  // namespace

AffineForm AxisView::gap(double side) const {
  const AffineForm first = (side > 0.0 ? ahead : -ahead) - width;
  const AffineForm last = first - (side > 0.0 ? way : -way);
  return first.lower() < last.lower() ? first : last;
}

AffineForm AxisView::overlap(double share) const {
  const AffineForm there = ahead - AffineForm(share) * way;
  const AffineForm one = width - there, other = width + there;
  return one.lower() < other.lower() ? one : other;
}

std::array<AxisView, 4> views_of(const UprightBox& part, const UprightBox& obstacle) {
  const auto axes = normals_of(part, obstacle);
  std::array<AxisView, 4> out;
  for (std::size_t i = 0; i < axes.size(); ++i) out[i] = view_along(axes[i], part, obstacle);
  return out;
}

std::array<AxisView, 5> views_on_way(const UprightBox& part, const UprightBox& obstacle,
                                     const AffineForm& way_x, const AffineForm& way_y) {
  const auto axes = normals_of(part, obstacle);
  std::array<AxisView, 5> out;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    out[i] = view_along(axes[i], part, obstacle);
    out[i].way = dot(axes[i], way_x, way_y);
  }
  const AffineForm scale(1.0 / std::max(std::hypot(way_x.center(), way_y.center()), 1e-9));
  out[4] = view_along({-way_y * scale, way_x * scale}, part, obstacle);
  return out;
}

}  // namespace parallax::harness
