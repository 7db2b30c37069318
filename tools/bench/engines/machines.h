#pragma once

#include <string>
#include <vector>

#include "harness/engine/physics_world.h"

namespace parallax::tools {

/// A machine whose motion is known in closed form, or from its equations of motion, solved by the
/// Runge-Kutta method with a step so short that its own error is negligible.
struct Machine {
  std::string name, held_against, unit;
  /// Error of its motion with this engine at steps of this length.
  double (*error)(harness::EngineKind engine, double timestep_s);
  double bound;  // of the error at steps of 2 ms, in every engine: what a test demands
  double none;   // an error below this is as good as none
};

/// A pendulum, a double pendulum, a block that slides, a door, a sphere that is thrown, and a load
/// that slips in a grip.
const std::vector<Machine>& machines();

}  // namespace parallax::tools
