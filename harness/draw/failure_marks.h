#pragma once

#include <string>

#include "harness/draw/scene.h"
#include "harness/simulator/simulator.h"
#include "harness/world/world_spec.h"

namespace parallax::harness {

/// "43 mm", "5.5 mm", "1.26 m"
std::string length_text(double length_m);

/// The origin of the body, if the scene has it.
std::optional<Eigen::Vector3d> origin_of(const Scene& scene, const std::string& body);

/// The point half way between the pads of an arm; `arm` is ignored for a robot on a line.
std::optional<Eigen::Vector3d> hand_of(const Scene& scene, const WorldSpec& spec,
                                       const std::string& arm);

/// Adds what measures a failure: how far out of reach something was (margin `reach`), and by how
/// much two bodies overlap where one would pass the other (margin `clearance`), with the hand where
/// it would meet what is in its way. `scene` is the world as it stands.
void add_failure_marks(const Scene& scene, const WorldSpec& spec, const State& arguments,
                       const Outcome& outcome, SceneAction& action);

}  // namespace parallax::harness
