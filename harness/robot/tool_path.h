#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "harness/engine/sweep.h"

namespace parallax::harness {

/// The corners of a way of the tool, its start left out; or what was in the way of the last try.
struct ToolPath {
  std::vector<Eigen::Vector3d> corners;
  std::optional<Obstacle> blocked;
};

/// A way from `from` to `to` on which the shapes of `sweep` (standing at `from`) meet nothing:
/// straight, or back along `back` (a unit vector), up, across, down and forward again, with the
/// shortest retreats and the lowest height that will do. Heights end at `ceiling_m`. No other ways
/// are tried. Cost: up to some hundred straight sweeps.
ToolPath find_tool_path(const Sweep& sweep, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                        const Eigen::Vector3d& back, double ceiling_m);

}  // namespace parallax::harness
