#pragma once

#include <string>
#include <vector>

#include "harness/world/structure_check.h"

namespace parallax::harness {

/// What is wrong with the settings of the engine.
void check_solver(const SolverSpec& solver, std::vector<WorldProblem>& problems);

/// What is wrong with a mobile robot, with places, grasps and handles. The rest of `spec` is right.
void check_mobile(const WorldSpec& spec, std::vector<WorldProblem>& problems);

}  // namespace parallax::harness
