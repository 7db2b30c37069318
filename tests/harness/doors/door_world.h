#pragma once

#include <filesystem>
#include <string>

#include "tests/harness/arms/arm_robot.h"
#include "tests/harness/config/scenario_text.h"

namespace parallax::harness::test {

/// A wall with a doorway and in it a door of 0.84 m, `hinge`, that opens towards the robot from 0
/// to 1.6 rad; on its side a bar. A box (`load`) that a start moves stands out of the way, a block
/// on `stand`.
inline const std::string kDoorWorld = R"(  include: robots/mobile_palm.yaml
  friction: {default: 0.5}
  solver: {timestep_s: 0.002, cfm: 0.000001, surface_layer_m: 0.0002, max_contacts_per_pair: 4}
  bodies:
    wall_left: {size_m: [0.1, 3.0, 2.5], position_m: [0, 2, 1.25]}
    wall_right: {size_m: [0.1, 3.0, 2.5], position_m: [0, -2, 1.25]}
    leaf:
      mass_kg: 20
      position_m: [-0.03, -0.005, 1.05]
      shapes:
        - {size_m: [0.04, 0.84, 2.0]}
        - {capsule: {radius_m: 0.01, length_m: 0.12}, at_m: [-0.07, 0.36, 0], roll_rad: 1.570796}
    load: {size_m: [0.4, 0.4, 0.4], mass_kg: 300, position_m: [3, 3, 0.2], settable: [x, y, mass]}
    stand: {size_m: [0.2, 0.2, 0.7], position_m: [-1.3, -0.4, 0.35]}
    block:
      size_m: [0.05, 0.05, 0.1]
      mass_kg: 0.3
      position_m: [-1.3, -0.4, 0.75]
      grasp: {at_m: [0, 0, 0.02], approach: above, width_m: 0.05, effort_n: 25}
  joints:
    hinge:
      type: hinge
      child: leaf
      axis: z
      at_m: [-0.03, -0.445, 1.05]
      range_rad: [0, 1.6]
      max_torque_nm: 0.5
      damping_nm_s: 2
      handle: {at_m: [-0.07, 0.36, 0], approach: [0, -1, 0], wrist_rad: 1.570796, width_m: 0.02}
  places:
    stand: {at_m: [-1.3, -0.4, 0.75]}
)";

/// A scenario with this under `world`, and with these actions.
inline std::string door_scenario(const std::string& world, const std::string& actions = " {}\n") {
  return "model: domain.e\nhorizon: 2\nworld:\n" + world + R"(
regions: {gaps: allowed, cells: {here: {x: [0, 1]}}}
mapping: {At(region): {inside: region, body: load, drawn: false}}
actions:)" +
         actions;
}

/// A folder with the robots that are shipped.
struct DoorWorkspace : Workspace {
  DoorWorkspace() {
    std::filesystem::copy(PARALLAX_SOURCE_DIR "/scenarios/robots", folder() / "robots",
                          std::filesystem::copy_options::recursive);
  }
};

/// The world of such a text, which must be sound.
inline WorldSpec door_world(const std::string& world = kDoorWorld) {
  DoorWorkspace workspace;
  const auto scenario = workspace.load(door_scenario(world));
  const auto reports = workspace.reports();
  CAPTURE(reports.empty() ? std::string() : reports.front());
  REQUIRE(scenario.has_value());
  return scenario->world;
}

/// Beside the arc of the door, turned to its hinge.
inline State beside(State more = {}) {
  more.insert({{"robot.x", -1.04}, {"robot.y", 0.21}, {"robot.yaw", -0.656}});
  return more;
}

}  // namespace parallax::harness::test
