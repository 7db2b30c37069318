#pragma once

#include <string>
#include <vector>

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

/// What is wrong with the parts of `spec` and with how they hang together, in their order: all that
/// can be said without building it. Empty: `lay_out` takes it.
std::vector<WorldProblem> check_structure(const WorldSpec& spec);

}  // namespace parallax::harness
