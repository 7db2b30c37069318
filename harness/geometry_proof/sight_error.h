#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "harness/geometry_proof/proof_scene.h"

namespace parallax::harness {

/// Where a camera looks for a body: along the longest middle line of its bounds, in its frame.
std::vector<Eigen::Vector3d> sighted_points(const BodySpec& body, int count);

/// By how much what rays find of a body may lie beside its own place, before errors are drawn.
struct SightError {
  double level_m = 0.0, height_m = 0.0;
};

/// From anywhere in the box. Of `Perception::sight`, which takes the median of what is left of
/// `points` along the longest middle line of the body, where at least `needed` are seen. A point's
/// estimate is the middle of the chord of its ray. Where the chord leaves a box through two sides
/// that lie about that line alike, its middle is the point, and the estimate is exact. As long as
/// fewer than half of those that are needed can be off towards the camera, and fewer than half away
/// from it, the median is exact in each coordinate that has one sign in all rays. Else it is off by
/// no more than the longest chord allows.
SightError sight_error(const ProofScene& scene, std::span<const Bounds1> box, BodyId body,
                       int points, int needed);

}  // namespace parallax::harness
