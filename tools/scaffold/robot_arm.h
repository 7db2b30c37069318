#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/kinematics/serial_chain.h"
#include "harness/world/world_spec.h"

namespace parallax::tools {

/// How far joints without stops may turn in an arm, either way.
inline constexpr double kEndlessRange_rad = 6.28;

/// The arm and the gripper of an imported robot.
struct FoundArm {
  harness::ArmSpec roles;            // without the base
  std::string root;                  // body that the first joint hangs on; empty: the world
  bool root_moves = false;           // else it stands fast in the world
  std::string follower;              // joint of the near pad
  bool is_coupled = false;           // the follower follows by itself
  double ratio = 1.0;                // of the follower
  std::vector<std::string> endless;  // joints of the chain without stops
  std::set<std::string> slides;      // joints of the chain that slide
};

/// Finds two fingers that slide against each other on one body, and the joints that lead there. The
/// greatest chain counts where there are several. None: there is no such gripper on an arm.
std::optional<FoundArm> find_arm(const harness::WorldSpec& world);

/// The place where the arm works (a table in front of its root) and its first posture.
struct WorkPlace {
  double x_m = 0.0, top_m = 0.0;            // middle of the table from the root, height of its top
  double aside_m = 0.0;                     // of the two spots, to the left and to the right
  std::map<std::string, double> positions;  // of the chain's joints from where they are imported
  std::map<std::string, double> strengths;  // that hold the arm in many postures [N or Nm]
};

/// Finds a posture in which the gripper points down with its pads along y, and a table that it
/// reaches from there, tried from the middle of the reach outwards. None: there is none.
/// `floor_m` is the height of the floor in this world.
std::optional<WorkPlace> find_work_place(harness::WorldSpec world, const FoundArm& arm,
                                         double floor_m);

}  // namespace parallax::tools
