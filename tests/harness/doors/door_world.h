#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

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

/// A start beside the arc of the door, turned to its hinge.
inline State beside(State more = {}) {
  more.insert({{"robot.x", -1.04}, {"robot.y", 0.21}, {"robot.yaw", -0.656}});
  return more;
}

inline const WorldSpec& house() {
  static const WorldSpec world = door_world();
  return world;
}

inline Outcome move(Robot& robot, const char* controller, State more = {}) {
  more.insert({{"arm", std::string("arm")}, {"joint", std::string("hinge")}});
  return robot.act(controller, more);
}
inline Outcome open(Robot& robot, State more = {}) {
  return move(robot, "open-door", std::move(more));
}
inline Outcome close(Robot& robot, State more = {}) {
  return move(robot, "close-door", std::move(more));
}
inline Outcome park(Robot& robot) { return robot.act("park", {{"arm", std::string("arm")}}); }
inline Outcome settle(Robot& robot, double time_s) {
  return robot.act("open-gripper", {{"arm", std::string("arm")}, {"settle_s", time_s}});
}
inline bool ok(const Outcome& outcome) { return outcome.status == SimStatus::kOk; }

inline double margin(const Outcome& outcome, const char* name) {
  return std::get<double>(outcome.margins.at(name));
}

/// The middle of the bar, from where the leaf is; not by the code that leads the hand.
inline Eigen::Vector3d bar(const Robot& robot) {
  return robot.position("leaf") + robot.rotation("leaf") * Eigen::Vector3d(-0.07, 0.36, 0.0);
}

inline double yaw_of(const Robot& robot, const char* body) {
  const Eigen::Matrix3d R = robot.rotation(body);
  return std::atan2(R(1, 0), R(0, 0));
}

/// The house seen in a mirror along y: the door turns the other way.
inline WorldSpec mirrored(WorldSpec spec) {
  body_of(spec, "leaf").p_WB.y() *= -1.0;
  for (BodyShape& shape : body_of(spec, "leaf").shapes) shape.p_BS.y() *= -1.0;
  JointSpec& hinge = joint_of(spec, "hinge");
  hinge.p_WA.y() *= -1.0;
  hinge.axis_W *= -1.0;
  hinge.handle->p_CH.y() *= -1.0;
  hinge.handle->approach.y() *= -1.0;
  for (const char* name : {"wall_left", "wall_right", "stand", "block"}) {
    body_of(spec, name).p_WB.y() *= -1.0;
  }
  return spec;
}

}  // namespace parallax::harness::test
