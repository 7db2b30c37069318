#include "harness/world/shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace parallax::harness {
namespace {

/// Without the turn about z, which comes last.
Eigen::Matrix3d tilt(const BodyShape& shape) {
  return (Eigen::AngleAxisd(shape.pitch_rad, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(shape.roll_rad, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

bool is_tilted(const BodyShape& shape) { return shape.roll_rad != 0.0 || shape.pitch_rad != 0.0; }

/// The length of a capsule between its caps.
double straight_m(const Eigen::Vector3d& size_m) { return std::max(size_m.z() - size_m.x(), 0.0); }

}  // namespace

Eigen::Matrix3d shape_rotation(const BodyShape& shape) {
  const double c = std::cos(shape.yaw_rad), s = std::sin(shape.yaw_rad);
  Eigen::Matrix3d R;
  R << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
  return is_tilted(shape) ? Eigen::Matrix3d(R * tilt(shape)) : R;
}

double volume_m3(const BodyShape& shape) {
  const double radius_m = 0.5 * shape.size_m.x();
  const double disc_m2 = std::numbers::pi * radius_m * radius_m;
  switch (shape.form) {
    case ShapeForm::kBox:
      break;
    case ShapeForm::kSphere:
      return disc_m2 * radius_m * 4.0 / 3.0;
    case ShapeForm::kCylinder:
      return disc_m2 * shape.size_m.z();
    case ShapeForm::kCapsule:
      return disc_m2 * (straight_m(shape.size_m) + radius_m * 4.0 / 3.0);
    case ShapeForm::kHull:
      return shape.hull->volume_m3;
  }
  return shape.size_m.prod();
}

Eigen::Vector3d centroid_B(const BodyShape& shape) {
  if (shape.form != ShapeForm::kHull) return shape.p_BS;
  return shape.p_BS + shape_rotation(shape) * shape.hull->centroid;
}

std::pair<Eigen::Vector3d, Eigen::Vector3d> span(ShapeForm form, const Eigen::Vector3d& size_m,
                                                 const ConvexHull* hull, const Eigen::Matrix3d& R) {
  if (form == ShapeForm::kHull) return hull->span(R);
  const Eigen::Vector3d half = half_extents(form, size_m, R);
  return {-half, half};
}

Eigen::Vector3d half_extents(ShapeForm form, const Eigen::Vector3d& size_m,
                             const Eigen::Matrix3d& R) {
  const double radius_m = 0.5 * size_m.x();
  const Eigen::Vector3d along = R.col(2).cwiseAbs();
  switch (form) {
    case ShapeForm::kBox:
    case ShapeForm::kHull:
      break;
    case ShapeForm::kSphere:
      return Eigen::Vector3d::Constant(radius_m);
    case ShapeForm::kCylinder:
      return 0.5 * size_m.z() * along +
             radius_m * (1.0 - along.array().square()).max(0.0).sqrt().matrix();
    case ShapeForm::kCapsule:
      return 0.5 * straight_m(size_m) * along + Eigen::Vector3d::Constant(radius_m);
  }
  return 0.5 * (R.cwiseAbs() * size_m);
}

bool contains(const BodyShape& shape, const Eigen::Vector3d& p_B) {
  const Eigen::AngleAxisd back(-shape.yaw_rad, Eigen::Vector3d::UnitZ());
  Eigen::Vector3d p_S = back * (p_B - shape.p_BS);
  if (is_tilted(shape)) p_S = Eigen::Vector3d(tilt(shape).transpose() * p_S);
  if (!(p_S.array().abs() <= 0.5 * shape.size_m.array()).all()) return false;
  const double radius_m = 0.5 * shape.size_m.x();
  switch (shape.form) {
    case ShapeForm::kBox:
      return true;
    case ShapeForm::kSphere:
      return p_S.norm() <= radius_m;
    case ShapeForm::kCylinder:
      return p_S.head<2>().norm() <= radius_m;
    case ShapeForm::kHull:
      return shape.hull->depth_of(p_S) >= 0.0;
    case ShapeForm::kCapsule:
      break;
  }
  const double half_m = 0.5 * straight_m(shape.size_m);
  p_S.z() -= std::clamp(p_S.z(), -half_m, half_m);
  return p_S.norm() <= radius_m;
}

Eigen::Vector3d round_size_m(ShapeForm form, double radius_m, double length_m) {
  const double across_m = 2.0 * radius_m;
  if (form == ShapeForm::kSphere) length_m = across_m;
  if (form == ShapeForm::kCapsule) length_m += across_m;
  return {across_m, across_m, length_m};
}

Eigen::Vector3d principal_moments(const Eigen::Matrix3d& I) {
  const double middle = I.trace() / 3.0;
  const Eigen::Matrix3d rest = I - middle * Eigen::Matrix3d::Identity();
  const double spread = std::sqrt(rest.squaredNorm() / 6.0);
  if (!(spread > 0.0)) return Eigen::Vector3d::Constant(middle);
  const double half =
      std::clamp(0.5 * rest.row(0).dot(rest.row(1).cross(rest.row(2))) / (spread * spread * spread),
                 -1.0, 1.0);
  const double angle = std::acos(half) / 3.0, third = 2.0 * std::numbers::pi / 3.0;
  const double high = middle + 2.0 * spread * std::cos(angle);
  const double low = middle + 2.0 * spread * std::cos(angle + third);
  return {low, 3.0 * middle - low - high, high};
}

}  // namespace parallax::harness
