#pragma once

#include <Eigen/Core>
#include <numbers>
#include <vector>

#include "harness/geometry_proof/affine_form.h"

namespace parallax::harness {

/// The second evaluation's allowance for rounding, and a full turn.
inline constexpr double kFlatRounding_m = 1e-9;
inline constexpr double kFullTurn_rad = 2.0 * std::numbers::pi;

/// A convex polygon, corners in order against the clock [m].
using Polygon = std::vector<Eigen::Vector2d>;

/// The convex hull of the points (Andrew's monotone chain).
Polygon hull_of(std::vector<Eigen::Vector2d> points);
/// The intersection of two convex polygons; empty if there is none (Sutherland and Hodgman).
Polygon common_part(const Polygon& a, const Polygon& b);
double area_of(const Polygon& polygon);
Eigen::Vector2d centroid_of(const Polygon& polygon);

/// A place in the plane that is known up to intervals.
struct PlanarRange {
  Bounds1 x, y, yaw;
  Eigen::Vector2d middle() const { return {0.5 * (x.lower + x.upper), 0.5 * (y.lower + y.upper)}; }
  double middle_yaw() const { return 0.5 * (yaw.lower + yaw.upper); }
};

/// The values that cos takes between two angles.
Bounds1 cosine_range(double from_rad, double to_rad);
/// How far the farthest of `corners`, carried by the frame, may reach along the unit vector at
/// `angle_rad`.
double farthest(const Polygon& corners, const PlanarRange& frame, double angle_rad);
/// Is the point inside the box (middle, half sizes and heading in the frame, smaller all round by
/// `margin_m`) wherever the frame is?
bool surely_inside(const Eigen::Vector2d& point, const PlanarRange& frame,
                   const Eigen::Vector2d& middle, double heading_rad, const Eigen::Vector2d& half,
                   double margin_m);

Polygon moved(const Polygon& corners, const Eigen::Vector2d& p, double yaw_rad);

}  // namespace parallax::harness
