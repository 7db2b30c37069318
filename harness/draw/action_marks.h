#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/draw/scene.h"
#include "harness/robot/perception.h"
#include "harness/simulator/simulator.h"

namespace parallax::harness {

/// The scene at one moment of an action.
struct SceneMoment {
  double time_s = 0.0;  // since it began
  Scene scene;
};

/// An action as it was seen, by whatever means.
struct SeenAction {
  std::string controller;
  State arguments;
  Outcome outcome;
  /// The first before the action, the last after it; about 20 kB each for a hundred boxes.
  std::vector<SceneMoment> moments;
  std::optional<Gaze> gaze;  // after it
  State after;               // observed then
};

/// The marks to draw for an action that was seen to its end.
SceneAction action_marks(const SeenAction& seen, const WorldSpec& spec);

}  // namespace parallax::harness
