#include "harness/robot/mobile_observation.h"

#include <cmath>

#include "harness/world/observables.h"

namespace parallax::harness {
namespace {

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
