#pragma once

#include <string>

#include "harness/draw/scene_view.h"

namespace parallax::harness {

/// The colour of places where the model predicts something.
inline constexpr const char* kPredictedColour = "#6a1fb0";

/// The marks of an action as SVG, in one view, over the world as it stands at its end: groups of
/// the classes `gaze`, `ghost`, `track`, `goal`, `sought`, `met`, `reach`, `predicted`, `differs`
/// and `measure`, as far as there are any.
std::string scene_marks(const SceneAction& action, const Scene& scene,
                        const Projection& projection);

/// The labels of measures and of predicted places, which find room before other names do.
std::string mark_labels(const SceneAction& action, SceneView& view);

}  // namespace parallax::harness
