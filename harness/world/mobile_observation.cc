#include "harness/world/mobile_observation.h"

#include <algorithm>
#include <cmath>

namespace parallax::harness {
namespace {

bool can_set(const BodySpec& body, std::string_view item) {
  return std::find(body.settable.begin(), body.settable.end(), item) != body.settable.end();
}

/// Sliders whose position says something: all but the fingers.
std::vector<SliderId> observed_sliders(const WorldLayout& layout, const MobileRobotSpec& robot) {
  std::vector<SliderId> found;
  for (std::size_t i = 0; i < layout.sliders.size(); ++i) {
    const SliderId id = layout.sliders.id_at(i);
    const std::string& name = layout.sliders[id].name;
    const bool finger = std::any_of(robot.arms.begin(), robot.arms.end(),
                                    [&](const ArmSpec& arm) { return arm.finger_joint == name; });
    if (!finger) found.push_back(id);
  }
  return found;
}

double yaw_of(const Eigen::Matrix3d& R) { return std::atan2(R(1, 0), R(0, 0)); }

void observe_arm(const MobileRobot& robot, const Arm& arm, State& out) {
  const std::string prefix = arm.spec().name + ".";
  const Eigen::Vector3d tool = arm.tool();
  out[prefix + "x"] = tool.x();
  out[prefix + "y"] = tool.y();
  out[prefix + "z"] = tool.z();
  out[prefix + "opening"] = arm.opening_m();
  out[prefix + "parked"] = robot.parked(arm);
  out[prefix + "open"] = robot.open(arm);
}

void observe_belief(const Perception& perception, BodyId id, const std::string& prefix,
                    State& out) {
  const auto seen = perception.believed(id);
  const Eigen::Vector3d p = seen.value_or(Eigen::Vector3d::Zero());
  out[prefix + "perceived"] = perception.belief(id).perceived;
  out[prefix + "seen.known"] = seen.has_value();
  out[prefix + "seen.x"] = p.x();
  out[prefix + "seen.y"] = p.y();
  out[prefix + "seen.z"] = p.z();
  out[prefix + "seen.bottom"] = perception.believed_bottom_m(id).value_or(0.0);
}

}  // namespace

std::vector<Parameter> mobile_parameters(const WorldSpec& spec, const WorldLayout& layout) {
  const MobileRobotSpec& robot = *spec.mobile;
  const BodyId base = *layout.find_body(robot.base_body);
  std::vector<Parameter> all;
  for (const char* item : {"x", "y"}) {
    all.push_back({std::string("robot.") + item, "m", can_set(layout.bodies[base], item)});
  }
  all.push_back({"robot.yaw", "rad", can_set(layout.bodies[base], "yaw")});
  all.push_back({"robot.lift", "m", false});
  all.push_back({"robot.looking_at", "1", false});
  for (const ArmSpec& arm : robot.arms) {
    for (const char* item : {".x", ".y", ".z", ".opening"}) all.push_back({arm.name + item, "m"});
    for (const char* item : {".parked", ".open"}) all.push_back({arm.name + item, "1"});
  }
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    if (!layout.is_free[i]) continue;
    const BodySpec& body = layout.bodies[layout.bodies.id_at(i)];
    all.push_back({body.name + ".bottom", "m", can_set(body, "bottom")});
    all.push_back({body.name + ".mass", "kg", can_set(body, "mass")});
    for (const ArmSpec& arm : robot.arms) all.push_back({body.name + ".held_by." + arm.name, "1"});
    for (const char* item : {".perceived", ".seen.known"}) all.push_back({body.name + item, "1"});
    for (const char* item : {".seen.x", ".seen.y", ".seen.z", ".seen.bottom"}) {
      all.push_back({body.name + item, "m"});
    }
  }
  for (const SliderId id : observed_sliders(layout, robot)) {
    const JointSpec& joint = layout.sliders[id];
    all.push_back({joint.name + ".q", "m"});
    for (const char* item : {".x", ".y", ".z"}) all.push_back({joint.child + item, "m"});
    all.push_back({joint.child + ".yaw", "rad"});
  }
  return all;
}

void observe_mobile(const OdeWorld& world, const MobileRobot& robot, const Perception& perception,
                    const GraspMonitor& grasp, State& out) {
  const PlanarPose pose = robot.base().pose();
  out["robot.x"] = pose.p.x();
  out["robot.y"] = pose.p.y();
  out["robot.yaw"] = pose.yaw_rad;
  out["robot.lift"] = robot.lift_m();
  out["robot.looking_at"] = perception.gaze();
  for (const Arm& arm : robot.arms()) observe_arm(robot, arm, out);
  const WorldLayout& layout = world.layout();
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    if (!layout.is_free[i]) continue;
    const BodyId id = layout.bodies.id_at(i);
    const std::string prefix = layout.bodies[id].name + ".";
    out[prefix + "bottom"] = world.bounds(id).low.z();
    out[prefix + "mass"] = world.mass_kg(id);
    for (const Arm& arm : robot.arms()) {
      out[prefix + "held_by." + arm.spec().name] = grasp.held_by(arm.gripper(), id);
    }
    observe_belief(perception, id, prefix, out);
  }
  for (const SliderId id : observed_sliders(layout, robot.spec())) {
    const JointSpec& joint = layout.sliders[id];
    const BodyId child = *layout.find_body(joint.child);
    const Eigen::Vector3d p = world.position(child);
    out[joint.name + ".q"] = world.slider_position_m(id);
    out[joint.child + ".x"] = p.x();
    out[joint.child + ".y"] = p.y();
    out[joint.child + ".z"] = p.z();
    out[joint.child + ".yaw"] = yaw_of(world.rotation(child));
  }
}

}  // namespace parallax::harness
