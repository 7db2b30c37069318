// Polygons in the plane, and where they may be while their frames are in ranges.
//
// Hulls by a sweep over sorted points, lower and upper half; the common part of two convex
// polygons by clipping one at each side of the other (Sutherland and Hodgman 1974). The cosine
// of a range of angles is exact: its ends, and 1 or -1 where the range passes them. From it
// follow how far a polygon reaches in a direction for all places and headings of its frame, and
// whether a box contains a point for all of them. Both are bounds on the safe side, as x, y and
// heading are taken as independent.

#include "harness/geometry_proof/flat_shapes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace parallax::harness {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

Bounds1 product(const Bounds1& a, const Bounds1& b) {
  const auto [low, high] =
      std::minmax({a.lower * b.lower, a.lower * b.upper, a.upper * b.lower, a.upper * b.upper});
  return {low, high};
}

}  // namespace

Polygon hull_of(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  Polygon hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t begin = hull.size();
    for (const Eigen::Vector2d& point : points) {
      while (hull.size() >= begin + 2 &&
             cross(hull.back() - hull[hull.size() - 2], point - hull.back()) <= 0.0) {
        hull.pop_back();
      }
      hull.push_back(point);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

Polygon common_part(const Polygon& a, const Polygon& b) {
  Polygon part = a;
  for (std::size_t i = 0; i < b.size() && !part.empty(); ++i) {
    const Eigen::Vector2d from = b[i], along = b[(i + 1) % b.size()] - from;
    Polygon next;
    for (std::size_t k = 0; k < part.size(); ++k) {
      const Eigen::Vector2d p = part[k], q = part[(k + 1) % part.size()];
      const double at_p = cross(along, p - from), at_q = cross(along, q - from);
      if (at_p >= 0.0) next.push_back(p);
      if ((at_p > 0.0 && at_q < 0.0) || (at_p < 0.0 && at_q > 0.0)) {
        next.push_back(p + at_p / (at_p - at_q) * (q - p));
      }
    }
    part = std::move(next);
  }
  return part;
}

double area_of(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  }
  return 0.5 * twice;
}

Eigen::Vector2d centroid_of(const Polygon& polygon) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& corner : polygon) sum += corner;
  return sum / static_cast<double>(polygon.size());
}

Bounds1 cosine_range(double from_rad, double to_rad) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const double a = std::cos(from_rad), b = std::cos(to_rad);
  Bounds1 range{std::min(a, b), std::max(a, b)};
  const auto passes = [&](double angle) {  // modulo full turns
    return std::floor((to_rad - angle) / kTurn) >= std::ceil((from_rad - angle) / kTurn);
  };
  if (passes(0.0)) range.upper = 1.0;
  if (passes(std::numbers::pi)) range.lower = -1.0;
  return range;
}

double farthest(const Polygon& corners, const PlanarRange& frame, double angle_rad) {
  const Bounds1 nx{std::cos(angle_rad), std::cos(angle_rad)};
  const Bounds1 ny{std::sin(angle_rad), std::sin(angle_rad)};
  const double origin = product(nx, frame.x).upper + product(ny, frame.y).upper;
  double most = -1e300;
  for (const Eigen::Vector2d& corner : corners) {
    const double shift = std::atan2(corner.y(), corner.x()) - angle_rad;
    const Bounds1 turn = cosine_range(frame.yaw.lower + shift, frame.yaw.upper + shift);
    most = std::max(most, corner.norm() * turn.upper);
  }
  return origin + most;
}

bool surely_inside(const Eigen::Vector2d& point, const PlanarRange& frame,
                   const Eigen::Vector2d& middle, double heading_rad, const Eigen::Vector2d& half,
                   double margin_m) {
  // The middle of the box turns about the frame's origin, the box about its middle.
  const double reach = middle.norm(), at = std::atan2(middle.y(), middle.x());
  constexpr double kQuarter = 0.5 * std::numbers::pi;
  const Bounds1 c = cosine_range(frame.yaw.lower + at, frame.yaw.upper + at);
  const Bounds1 s = cosine_range(frame.yaw.lower + at - kQuarter, frame.yaw.upper + at - kQuarter);
  const Bounds1 dx{point.x() - frame.x.upper - reach * c.upper,
                   point.x() - frame.x.lower - reach * c.lower};
  const Bounds1 dy{point.y() - frame.y.upper - reach * s.upper,
                   point.y() - frame.y.lower - reach * s.lower};
  const double low = frame.yaw.lower + heading_rad, high = frame.yaw.upper + heading_rad;
  const Bounds1 ux = cosine_range(low, high), uy = cosine_range(low - kQuarter, high - kQuarter);
  const Bounds1 a = product(dx, ux), b = product(dy, uy), e = product(dy, ux), f = product(dx, uy);
  const double limit_x = half.x() - margin_m, limit_y = half.y() - margin_m;
  return a.lower + b.lower > -limit_x && a.upper + b.upper < limit_x &&
         e.lower - f.upper > -limit_y && e.upper - f.lower < limit_y;
}

Polygon moved(const Polygon& corners, const Eigen::Vector2d& p, double yaw_rad) {
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
  Polygon out;
  for (const Eigen::Vector2d& v : corners) {
    out.push_back(p + Eigen::Vector2d(c * v.x() - s * v.y(), s * v.x() + c * v.y()));
  }
  return out;
}

}  // namespace parallax::harness
