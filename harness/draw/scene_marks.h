#pragma once

#include <string>

#include "harness/draw/scene_view.h"

namespace parallax::harness {

/// Of where the model says that something is.
inline constexpr const char* kPredictedColour = "#6a1fb0";

/// SVG of what an action did, in one view, over the world as it stands at its end: groups of the
/// classes `gaze`, `ghost`, `track`, `goal`, `sought`, `met`, `reach`, `predicted`, `differs` and
/// `measure`, those that there are.
std::string scene_marks(const SceneAction& action, const Scene& scene,
                        const Projection& projection);

/// The labels of the measures and of what was predicted, which find places before other names do.
std::string mark_labels(const SceneAction& action, SceneView& view);

}  // namespace parallax::harness
