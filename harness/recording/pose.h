#pragma once

#include <array>

namespace parallax::harness {

/// The pose of a body: position [m], unit quaternion w-x-y-z.
struct Pose {
  std::array<double, 3> p = {0.0, 0.0, 0.0};
  std::array<double, 4> q = {1.0, 0.0, 0.0, 0.0};
  friend bool operator==(const Pose&, const Pose&) = default;
};

/// q * r.
inline std::array<double, 4> turned(const std::array<double, 4>& q,
                                    const std::array<double, 4>& r) {
  return {q[0] * r[0] - q[1] * r[1] - q[2] * r[2] - q[3] * r[3],
          q[0] * r[1] + q[1] * r[0] + q[2] * r[3] - q[3] * r[2],
          q[0] * r[2] - q[1] * r[3] + q[2] * r[0] + q[3] * r[1],
          q[0] * r[3] + q[1] * r[2] - q[2] * r[1] + q[3] * r[0]};
}

/// The point `p` of a frame, in the frame that `pose` is given in [m].
inline std::array<double, 3> point_of(const Pose& pose, const std::array<double, 3>& p) {
  const auto& q = pose.q;
  const auto v = turned(turned(q, {0.0, p[0], p[1], p[2]}), {q[0], -q[1], -q[2], -q[3]});
  return {pose.p[0] + v[1], pose.p[1] + v[2], pose.p[2] + v[3]};
}

/// X_WB and X_BC to X_WC.
inline Pose composed(const Pose& outer, const Pose& inner) {
  return {point_of(outer, inner.p), turned(outer.q, inner.q)};
}

}  // namespace parallax::harness
