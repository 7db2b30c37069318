#pragma once

#include <string>
#include <vector>

#include "harness/world/world_check.h"

namespace parallax::harness {

/// What is wrong with the settings of the engine.
void check_solver(const SolverSpec& solver, std::vector<WorldProblem>& problems);

/// What is wrong with a mobile robot, with places, grasps and handles. The rest of `spec` is right.
void check_mobile(const WorldSpec& spec, std::vector<WorldProblem>& problems);

/// What cannot work whatever the start: drawers that stick in their bay, handles that no arm
/// reaches from anywhere, places in the air or inside furniture.
void check_geometry(const WorldSpec& spec, std::vector<WorldProblem>& problems);

/// Grippers that cannot hold anything, and grasps and handles that no gripper can hold.
void check_grippers(const WorldSpec& spec, std::vector<WorldProblem>& problems);

/// Bodies that overlap, or reach into the floor, whatever start is drawn; furniture that stands
/// where other furniture is.
void check_overlaps(const WorldSpec& spec, std::vector<WorldProblem>& problems);

struct NamedPoint {
  std::string name;
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  // [m]
};

/// Which points nothing but the robot and free bodies touches: what is put there falls. `spec` must
/// pass check_world.
std::vector<std::string> unsupported_points(const WorldSpec& spec,
                                            const std::vector<NamedPoint>& points);

}  // namespace parallax::harness
