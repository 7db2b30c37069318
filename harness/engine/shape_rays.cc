// Rays against shapes in closed form.
//
// A line meets a convex shape in one stretch. That of a box, a hull or the flat ends of a cylinder
// is what the half-spaces of their faces leave of it (Cyrus and Beck, Computer Graphics and Image
// Processing 7, 1978); that of a sphere or a cylinder's side comes from a quadratic equation. The
// stretch of a cylinder is the common part of two, that of a capsule reaches from the first to the
// last point of three that touch each other. Cost: linear in the faces of a hull.

#include "harness/engine/shape_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace parallax::harness {
namespace {

constexpr double kFar_m = std::numeric_limits<double>::infinity();

/// The part of a line that is in a shape; empty where `out_m` is less than `in_m`.
struct Stretch {
  double in_m = -kFar_m, out_m = kFar_m;
  bool is_empty() const { return in_m > out_m; }
  /// Leaves what is below a plane: it begins `above_m` over it and rises at `rate`.
  void cut(double above_m, double rate) {
    if (rate < 0.0) in_m = std::max(in_m, -above_m / rate);
    if (rate > 0.0) out_m = std::min(out_m, -above_m / rate);
    if (rate == 0.0 && above_m > 0.0) out_m = -kFar_m;
  }
};

Stretch in_box(const Eigen::Vector3d& half_m, const Eigen::Vector3d& from,
               const Eigen::Vector3d& direction) {
  Stretch part;
  for (int axis = 0; axis < 3; ++axis) {
    part.cut(from[axis] - half_m[axis], direction[axis]);
    part.cut(-from[axis] - half_m[axis], -direction[axis]);
  }
  return part;
}

Stretch in_hull(const ConvexHull& hull, const Eigen::Vector3d& from,
                const Eigen::Vector3d& direction) {
  Stretch part;
  for (std::size_t i = 0; i < hull.normals.size(); ++i) {
    part.cut(hull.normals[i].dot(from) - hull.offsets[i], hull.normals[i].dot(direction));
  }
  return part;
}

/// The values of t for which `d` + t `u` is no longer than the radius.
template <typename Vector>
Stretch in_round(double radius_m, const Vector& d, const Vector& u) {
  const double a = u.squaredNorm(), b = d.dot(u), c = d.squaredNorm() - radius_m * radius_m;
  Stretch part;
  if (a == 0.0) {
    part.cut(c, 0.0);
    return part;
  }
  const double root = b * b - a * c;
  if (root < 0.0) return {kFar_m, -kFar_m};
  return {(-b - std::sqrt(root)) / a, (-b + std::sqrt(root)) / a};
}

Stretch in_cylinder(double radius_m, double half_m, const Eigen::Vector3d& from,
                    const Eigen::Vector3d& direction) {
  Stretch part = in_round<Eigen::Vector2d>(radius_m, from.head<2>(), direction.head<2>());
  part.cut(from.z() - half_m, direction.z());
  part.cut(-from.z() - half_m, -direction.z());
  return part;
}

Stretch in_capsule(double radius_m, double half_m, const Eigen::Vector3d& from,
                   const Eigen::Vector3d& direction) {
  Stretch whole = in_cylinder(radius_m, half_m, from, direction);
  for (const double end_m : {-half_m, half_m}) {
    const Stretch cap =
        in_round<Eigen::Vector3d>(radius_m, from - end_m * Eigen::Vector3d::UnitZ(), direction);
    if (cap.is_empty()) continue;
    if (whole.is_empty()) {
      whole = cap;
    } else {
      whole = {std::min(whole.in_m, cap.in_m), std::max(whole.out_m, cap.out_m)};
    }
  }
  return whole;
}

Stretch stretch_in(ShapeForm form, const Eigen::Vector3d& size_m, const ConvexHull* hull,
                   const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
  const double radius_m = 0.5 * size_m.x();
  switch (form) {
    case ShapeForm::kBox:
      return in_box(0.5 * size_m, from, direction);
    case ShapeForm::kSphere:
      return in_round<Eigen::Vector3d>(radius_m, from, direction);
    case ShapeForm::kCylinder:
      return in_cylinder(radius_m, 0.5 * size_m.z(), from, direction);
    case ShapeForm::kCapsule:
      return in_capsule(radius_m, 0.5 * (size_m.z() - size_m.x()), from, direction);
    case ShapeForm::kHull:
      break;
  }
  return in_hull(*hull, from, direction);
}

}  // namespace

std::optional<double> ray_meets_shape(ShapeForm form, const Eigen::Vector3d& size_m,
                                      const ConvexHull* hull, const Eigen::Vector3d& from_S,
                                      const Eigen::Vector3d& direction_S) {
  const Stretch part = stretch_in(form, size_m, hull, from_S, direction_S);
  if (part.is_empty() || part.out_m < 0.0) return std::nullopt;
  return part.in_m >= 0.0 ? part.in_m : part.out_m;
}

}  // namespace parallax::harness
