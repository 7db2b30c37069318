#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "harness/geometry_proof/proof_scene.h"

namespace parallax::harness {

/// The points at which a camera looks for a body: along the longest middle line of its bounds, in
/// its frame.
std::vector<Eigen::Vector3d> sighted_points(const BodySpec& body, int count);

/// Bounds on the offset of a body's place as rays find it, before errors are drawn.
struct SightError {
  double level_m = 0.0, height_m = 0.0;
};

/// The error of `Perception::sight`, from anywhere in the box. That takes the median of the visible
/// ones of `points` points along the longest middle line of the body, if at least `needed` are
/// seen. The estimate for a point is the middle of the chord of its ray. If the chord leaves a box
/// through two sides that lie alike about that line, its middle is the point, and the estimate is
/// exact. As long as fewer than half of the needed points can be off towards the camera, and fewer
/// than half away from it, the median is exact in each coordinate that has one sign in all rays.
/// Otherwise the error is at most what the longest chord allows.
SightError sight_error(const ProofScene& scene, std::span<const Bounds1> box, BodyId body,
                       int points, int needed);

}  // namespace parallax::harness
