#pragma once

#include <Eigen/Core>
#include <cmath>

namespace parallax::harness {

/// `angle_rad` moved by full turns into (-pi, pi].
inline double wrapped(double angle_rad) {
  return std::atan2(std::sin(angle_rad), std::cos(angle_rad));
}

/// The heading of the x axis of a frame with this rotation, seen from above.
inline double heading_rad(const Eigen::Matrix3d& R) { return std::atan2(R(1, 0), R(0, 0)); }

/// `p` turned by `angle_rad` about the vertical through `centre`.
inline Eigen::Vector3d round_vertical(const Eigen::Vector3d& p, const Eigen::Vector3d& centre,
                                      double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  const Eigen::Vector3d d = p - centre;
  return centre + Eigen::Vector3d(c * d.x() - s * d.y(), s * d.x() + c * d.y(), d.z());
}

}  // namespace parallax::harness
