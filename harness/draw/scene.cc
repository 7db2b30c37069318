#include "harness/draw/scene.h"

#include <algorithm>

namespace parallax::harness {
namespace {

SceneKind kind_of(const WorldLayout& layout, const WorldSpec& spec, BodyId id) {
  if (!layout.link_of[id.index()]) return SceneKind::kFurniture;
  if (layout.is_free[id.index()]) return SceneKind::kItem;
  const auto base = layout.find_body(base_body(spec));
  if (!base || layout.assembly_of[id.index()] != layout.assembly_of[base->index()]) {
    return SceneKind::kDrawer;
  }
  const std::string& name = layout.bodies[id].name;
  const auto all = grippers(spec);
  const bool pad = std::any_of(all.begin(), all.end(), [&](const GripperSpec& gripper) {
    return gripper.near_pad_body == name || gripper.far_pad_body == name;
  });
  return pad ? SceneKind::kGripper : SceneKind::kRobot;
}

std::vector<SceneArm> arms_of(const OdeWorld& world, const MobileRobotSpec& robot) {
  const WorldLayout& layout = world.layout();
  const auto base = layout.find_body(robot.base_body);
  const auto torso = layout.find_slider(robot.torso_joint);
  const double lift_m = torso ? world.slider_position_m(*torso) : 0.0;
  std::vector<SceneArm> arms;
  for (const ArmSpec& arm : robot.arms) {
    const auto palm = layout.find_body(arm.palm_body);
    if (!base || !palm) continue;
    const Eigen::Vector3d p_BS = arm.p_BS + lift_m * Eigen::Vector3d::UnitZ();
    arms.push_back(
        {arm.name, world.position(*base) + world.rotation(*base) * p_BS, world.position(*palm)});
  }
  return arms;
}

}  // namespace

Scene scene_of(const OdeWorld& world, const WorldSpec& spec) {
  Scene scene;
  const WorldLayout& layout = world.layout();
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    const BodyId id = layout.bodies.id_at(i);
    for (const BoxShape& shape : layout.bodies[id].shapes) {
      scene.boxes.push_back({layout.bodies[id].name, kind_of(layout, spec, id),
                             world.placed(id, shape), world.position(id)});
    }
  }
  scene.base = base_body(spec);
  if (spec.mobile) scene.arms = arms_of(world, *spec.mobile);
  return scene;
}

}  // namespace parallax::harness
