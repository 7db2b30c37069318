#pragma once

#include <string>
#include <vector>

#include "harness/draw/projection.h"
#include "harness/draw/scene_action.h"

namespace parallax::harness {

/// Of what went wrong.
inline constexpr const char* kWarningColour = "#c00020";

/// With the first point again at the end.
std::vector<Eigen::Vector2d> closed(std::vector<Eigen::Vector2d> points);

/// SVG of what an action did, in one view, over the world as it stands at its end: groups of the
/// classes `gaze`, `ghost`, `track`, `goal`, `sought` and `met`, those that there are.
std::string marks(const SceneAction& action, const Scene& scene, const Projection& projection);

}  // namespace parallax::harness
