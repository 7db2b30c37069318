#pragma once

#include <Eigen/Core>
#include <cmath>

namespace parallax::harness {

/// `angle_rad` moved by full turns into (-pi, pi].
inline double wrapped(double angle_rad) {
  return std::atan2(std::sin(angle_rad), std::cos(angle_rad));
}

/// Where the x axis of a frame with this rotation points, seen from above.
inline double heading_rad(const Eigen::Matrix3d& R) { return std::atan2(R(1, 0), R(0, 0)); }

}  // namespace parallax::harness
