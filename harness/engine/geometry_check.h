#pragma once

#include <vector>

#include "harness/world/structure_check.h"

namespace parallax::harness {

/// What cannot work whatever the start: drawers that stick in their bay, handles that no arm
/// reaches from anywhere, places in the air or inside furniture.
void check_geometry(const WorldSpec& spec, std::vector<WorldProblem>& problems);

/// Grippers that cannot hold anything, and grasps and handles that no gripper can hold.
void check_grippers(const WorldSpec& spec, std::vector<WorldProblem>& problems);

/// Bodies that overlap, or reach into the floor, whatever start is drawn; furniture that stands
/// where other furniture is.
void check_overlaps(const WorldSpec& spec, std::vector<WorldProblem>& problems);

}  // namespace parallax::harness
