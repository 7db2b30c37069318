#pragma once

#include <Eigen/Core>
#include <vector>

#include "harness/world/world_spec.h"

namespace parallax::harness {

/// A box of a body at its default placement: upright, turned about z.
struct SolidBox {
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero(), p_WS = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;
  bool contains(const Eigen::Vector3d& p_W) const;
  bool contains(const SolidBox& other) const;  // all its corners: both are convex
};

/// The boxes of a body that collides; none of another.
std::vector<SolidBox> solid_boxes(const BodySpec& body);

}  // namespace parallax::harness
