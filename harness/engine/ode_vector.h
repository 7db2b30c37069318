#pragma once

#include <ode/common.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

// Conversions between the engine's numbers and Eigen's; for ode_*.cc.

namespace parallax::harness {

inline Eigen::Vector3d to_vector(const dReal* v) { return {v[0], v[1], v[2]}; }

inline Eigen::Matrix3d to_matrix(const dReal* R) {
  Eigen::Matrix3d out;
  out << R[0], R[1], R[2], R[4], R[5], R[6], R[8], R[9], R[10];
  return out;
}

inline Eigen::Quaterniond to_quaternion(const dReal* q) { return {q[0], q[1], q[2], q[3]}; }

}  // namespace parallax::harness
