#pragma once

#include <string>
#include <vector>

#include "harness/world/simulator.h"
#include "harness/world/world_spec.h"

namespace parallax::harness {

inline constexpr double kMaxMass_kg = 1e6;      // what is heavier is a slip of the pen
inline constexpr double kMaxExtent_m = 1000.0;  // likewise of sizes and places

/// One thing wrong with a WorldSpec. `path` leads to it, names instead of indices:
/// "bodies/box/mass_kg", "joints/lift/parent", "robot/base_joint", "solver/timestep_s".
struct WorldProblem {
  std::string path;
  std::string message;     // "no body `palmm`"
  std::string suggestion;  // a name that exists, or empty
};

/// Everything wrong with `spec`, in the order of its parts. Empty: OdeSimulator takes it.
std::vector<WorldProblem> check_world(const WorldSpec& spec);

/// The variables that a simulator made from `spec` observes, sorted by name, without building it:
/// NAME.x .y .z .roll .pitch .yaw .held for each free body, robot.x, tool.x, tool.z, opening.
/// Besides these an observation has "digest".
std::vector<Parameter> observables(const WorldSpec& spec);

}  // namespace parallax::harness
