// Areas of the floor plan as unions of rings and simple polygons.
//
// A polygon is cut into triangles by its ears (Meisters 1975). Sizes of rings and triangles add
// up to one scale; the first number of a uniform pair chooses the piece by size, its remainder
// and the second number choose the point in it: for a triangle by the square root map, for a
// ring by the radius whose circle has that size. So equal parts of the unit square go to equal
// sizes. Where shapes overlap, the first one that a point is in answers for it and the others
// have none, so the union is uniform as well. A point is in a polygon if a ray from it crosses
// the border an odd number of times.
//
// Cost: ears take the cube of the corners at worst, once; a point is linear in pieces and
// corners.

#include "harness/region/area.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "compiler/base/contract.h"

namespace parallax::harness {
namespace {

/// Twice the signed size of the triangle; above 0 where it turns left.
double cross_of(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

double signed_size(const std::vector<PlanePoint>& corners) {
  double twice = 0.0;
  // Relative to a corner, so that far from the origin no digits are lost.
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    twice += cross_of(corners[0], corners[i], corners[i + 1]);
  }
  return 0.5 * twice;
}

bool within_box(const PlanePoint& p, const PlanePoint& a, const PlanePoint& b) {
  return std::min(a[0], b[0]) <= p[0] && p[0] <= std::max(a[0], b[0]) &&
         std::min(a[1], b[1]) <= p[1] && p[1] <= std::max(a[1], b[1]);
}

int sign_of(double value) { return value > 0.0 ? 1 : value < 0.0 ? -1 : 0; }

/// Have two stretches a point in common?
bool edges_meet(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c,
                const PlanePoint& d) {
  const int ac = sign_of(cross_of(a, b, c)), ad = sign_of(cross_of(a, b, d));
  const int ca = sign_of(cross_of(c, d, a)), cb = sign_of(cross_of(c, d, b));
  if (ac * ad < 0 && ca * cb < 0) return true;
  return (ac == 0 && within_box(c, a, b)) || (ad == 0 && within_box(d, a, b)) ||
         (ca == 0 && within_box(a, c, d)) || (cb == 0 && within_box(b, c, d));
}

std::string point_text(const PlanePoint& point) {
  return fmt::format("({:g}, {:g})", point[0], point[1]);
}

std::string polygon_fault(const std::vector<PlanePoint>& corners) {
  const auto n = corners.size();
  if (n < 3) return fmt::format("has {} corners", n);
  const auto next = [n](std::size_t i) { return (i + 1) % n; };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      if (corners[i] == corners[j]) {
        return fmt::format("goes through {} twice", point_text(corners[i]));
      }
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      const auto &a = corners[i], &b = corners[next(i)], &c = corners[j], &d = corners[next(j)];
      bool meets = false;
      if (next(i) == j) {  // they share a corner, and may not go back on themselves
        meets = cross_of(a, b, d) == 0.0 && (within_box(d, a, b) || within_box(a, b, d));
      } else if (next(j) == i) {
        meets = cross_of(c, d, b) == 0.0 && (within_box(b, c, d) || within_box(c, a, b));
      } else {
        meets = edges_meet(a, b, c, d);
      }
      if (meets) {
        return fmt::format("crosses or touches itself between {} and {}", point_text(a),
                           point_text(b));
      }
    }
  }
  if (!(std::abs(signed_size(corners)) > 0.0)) return "has no size";
  return {};
}

/// Cuts a simple polygon with counterclockwise corners into triangles: repeatedly cuts off a corner
/// whose triangle holds no other corner (Meisters 1975, Polygons have ears).
std::vector<std::array<PlanePoint, 3>> ears_of(std::vector<PlanePoint> corners) {
  std::vector<std::array<PlanePoint, 3>> out;
  const auto is_ear = [&](std::size_t i) {
    const auto n = corners.size();
    const auto &a = corners[(i + n - 1) % n], &b = corners[i], &c = corners[(i + 1) % n];
    if (!(cross_of(a, b, c) > 0.0)) return false;
    for (const auto& p : corners) {
      if (p == a || p == b || p == c) continue;
      if (cross_of(a, b, p) >= 0.0 && cross_of(b, c, p) >= 0.0 && cross_of(c, a, p) >= 0.0) {
        return false;
      }
    }
    return true;
  };
  while (corners.size() > 3) {
    const auto n = corners.size();
    std::size_t ear = n;
    for (std::size_t i = 0; i < n && ear == n; ++i) {
      // A corner on a straight line is not a corner.
      if (cross_of(corners[(i + n - 1) % n], corners[i], corners[(i + 1) % n]) == 0.0) ear = i;
    }
    for (std::size_t i = 0; i < n && ear == n; ++i) {
      if (is_ear(i)) ear = i;
    }
    // Rounding may hide the last ears, whose size is then that of rounding.
    if (ear == n) ear = 0;
    out.push_back({corners[(ear + n - 1) % n], corners[ear], corners[(ear + 1) % n]});
    corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  out.push_back({corners[0], corners[1], corners[2]});
  return out;
}

bool polygon_contains(const std::vector<PlanePoint>& corners, const PlanePoint& p) {
  bool inside = false;
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const auto &a = corners[i], &b = corners[j];
    if ((a[1] > p[1]) == (b[1] > p[1])) continue;
    if (p[0] < (b[0] - a[0]) * (p[1] - a[1]) / (b[1] - a[1]) + a[0]) inside = !inside;
  }
  return inside;
}

double distance_to_edge(const PlanePoint& p, const PlanePoint& a, const PlanePoint& b) {
  const double dx = b[0] - a[0], dy = b[1] - a[1];
  const double along = ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / (dx * dx + dy * dy);
  const double t = std::clamp(along, 0.0, 1.0);
  return std::hypot(p[0] - a[0] - t * dx, p[1] - a[1] - t * dy);
}

double distance_from(const RingShape& ring, const PlanePoint& p) {
  const double radius = std::hypot(p[0] - ring.at[0], p[1] - ring.at[1]);
  if (ring.inner_m == 0.0) return ring.outer_m - radius;
  return std::min(ring.outer_m - radius, radius - ring.inner_m);
}

double distance_from(const PolygonShape& polygon, const PlanePoint& p) {
  const auto& corners = polygon.corners;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    least = std::min(least, distance_to_edge(p, corners[j], corners[i]));
  }
  return polygon_contains(corners, p) ? least : -least;
}

bool shape_contains(const PlaneShape& shape, const PlanePoint& p) {
  if (const auto* ring = std::get_if<RingShape>(&shape)) {
    const double radius = std::hypot(p[0] - ring->at[0], p[1] - ring->at[1]);
    return radius >= ring->inner_m && radius <= ring->outer_m;
  }
  return polygon_contains(std::get<PolygonShape>(shape).corners, p);
}

std::string shape_text(const PlaneShape& shape, const PlanePoint& offset) {
  if (const auto* ring = std::get_if<RingShape>(&shape)) {
    const auto around = point_text({ring->at[0] + offset[0], ring->at[1] + offset[1]});
    if (ring->inner_m == 0.0)
      return fmt::format("a disc of {:g} m around {}", ring->outer_m, around);
    return fmt::format("a ring of {:g} to {:g} m around {}", ring->inner_m, ring->outer_m, around);
  }
  std::vector<std::string> corners;
  constexpr std::size_t kMost = 6;
  const auto& all = std::get<PolygonShape>(shape).corners;
  for (const auto& corner : all) {
    if (corners.size() == kMost) {
      corners.push_back(fmt::format("... {} in all", all.size()));
      break;
    }
    corners.push_back(point_text({corner[0] + offset[0], corner[1] + offset[1]}));
  }
  return fmt::format("the polygon {}", fmt::join(corners, " "));
}

}  // namespace

std::string fault_of(const PlaneShape& shape) {
  const auto* ring = std::get_if<RingShape>(&shape);
  if (ring == nullptr) return polygon_fault(std::get<PolygonShape>(shape).corners);
  if (ring->inner_m < 0.0) return fmt::format("has an inner radius of {:g} m", ring->inner_m);
  if (ring->inner_m < ring->outer_m) return {};
  return fmt::format("goes from {:g} to {:g} m", ring->inner_m, ring->outer_m);
}

Area::Area(std::vector<PlaneShape> shapes) {
  PARALLAX_REQUIRE(!shapes.empty(), "an area of at least one shape");
  double sum = 0.0;
  for (auto& shape : shapes) {
    Part part{std::move(shape), {}};
    if (const auto* ring = std::get_if<RingShape>(&part.shape)) {
      sum += std::numbers::pi * (ring->outer_m - ring->inner_m) * (ring->outer_m + ring->inner_m);
    } else {
      auto& corners = std::get<PolygonShape>(part.shape).corners;
      if (signed_size(corners) < 0.0) std::reverse(corners.begin(), corners.end());
      for (const auto& ear : ears_of(corners)) {
        const double size = 0.5 * cross_of(ear[0], ear[1], ear[2]);
        if (!(size > 0.0)) continue;
        part.triangles.push_back({ear, size});
        sum += size;
      }
    }
    parts_.push_back(std::move(part));
    cumulative_.push_back(sum);
  }
}

bool Area::contains(const PlanePoint& point) const {
  return std::any_of(parts_.begin(), parts_.end(),
                     [&](const Part& part) { return shape_contains(part.shape, point); });
}

double Area::signed_distance_m(const PlanePoint& point) const {
  double most = -std::numeric_limits<double>::infinity();
  for (const auto& part : parts_) {
    most = std::max(most, std::visit([&](const auto& shape) { return distance_from(shape, point); },
                                     part.shape));
  }
  return most;
}

std::pair<PlanePoint, PlanePoint> Area::bounds() const {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  PlanePoint lower = {kFar, kFar}, upper = {-kFar, -kFar};
  const auto include = [&](const PlanePoint& point, double radius) {
    for (std::size_t i = 0; i < 2; ++i) {
      lower[i] = std::min(lower[i], point[i] - radius);
      upper[i] = std::max(upper[i], point[i] + radius);
    }
  };
  for (const auto& part : parts_) {
    if (const auto* ring = std::get_if<RingShape>(&part.shape)) {
      include(ring->at, ring->outer_m);
    } else {
      for (const auto& corner : std::get<PolygonShape>(part.shape).corners) include(corner, 0.0);
    }
  }
  return {lower, upper};
}

std::optional<PlanePoint> Area::at(double u, double v) const {
  const double wanted = u * cumulative_.back();
  std::size_t part = 0;
  while (part + 1 < parts_.size() && wanted >= cumulative_[part]) ++part;
  // The remainder of `u` after the choice is uniform again.
  double left = wanted - (part == 0 ? 0.0 : cumulative_[part - 1]);
  PlanePoint point{};
  if (const auto* ring = std::get_if<RingShape>(&parts_[part].shape)) {
    const double square = ring->inner_m * ring->inner_m + left / std::numbers::pi;
    const double radius = std::clamp(std::sqrt(square), ring->inner_m, ring->outer_m);
    const double angle = 2.0 * std::numbers::pi * v;
    point = {ring->at[0] + radius * std::cos(angle), ring->at[1] + radius * std::sin(angle)};
  } else {
    const auto& triangles = parts_[part].triangles;
    std::size_t i = 0;
    while (i + 1 < triangles.size() && left >= triangles[i].size_m2) left -= triangles[i++].size_m2;
    const auto& [a, b, c] = triangles[i].corners;
    const double s = std::sqrt(std::clamp(left / triangles[i].size_m2, 0.0, 1.0));
    for (std::size_t k = 0; k < 2; ++k) {
      point[k] = (1.0 - s) * a[k] + s * (1.0 - v) * b[k] + s * v * c[k];
    }
  }
  // The first shape that a point is in answers for it, so that overlaps count once.
  for (std::size_t earlier = 0; earlier < part; ++earlier) {
    if (shape_contains(parts_[earlier].shape, point)) return std::nullopt;
  }
  return point;
}

std::string Area::text(const PlanePoint& offset) const {
  std::vector<std::string> texts;
  for (const auto& part : parts_) texts.push_back(shape_text(part.shape, offset));
  return fmt::format("{}", fmt::join(texts, " or "));
}

}  // namespace parallax::harness
