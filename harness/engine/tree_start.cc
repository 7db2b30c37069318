#include "harness/engine/tree_start.h"

#include "harness/world/angles.h"

namespace parallax::harness {
namespace {

struct PlacedLink {
  Eigen::Vector3d p_WL = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;
};

PlacedLink place_by(const TreeLink& link, std::span<const Placement> placements) {
  const Placement& at = placements[link.frame.index()];
  return {at.p_WB, at.yaw_rad};
}

PlacedLink default_place(const WorldLayout& layout, const TreeLink& link) {
  const BodySpec& body = layout.bodies[link.frame];
  return {body.p_WB, body.yaw_rad};
}

/// The centre of mass and the heading of a link in its parent.
struct PlaceInParent {
  Eigen::Vector3d p_PC = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;
};

PlaceInParent in_parent(const TreeLink& link, const PlacedLink& own, const PlacedLink& parent) {
  const Eigen::Vector3d p_WC = own.p_WL + rotation_about_z(own.yaw_rad) * link.p_LC;
  return {rotation_about_z(-parent.yaw_rad) * (p_WC - parent.p_WL), own.yaw_rad - parent.yaw_rad};
}

}  // namespace

LinkStart start_of(const WorldLayout& layout, const LinkTree& tree, LinkId id,
                   std::span<const Placement> placements) {
  const TreeLink& link = tree.links[id];
  const PlacedLink own = place_by(link, placements);
  LinkStart start{own.p_WL, own.yaw_rad};
  if (link.joint != LinkJoint::kSlider && link.joint != LinkJoint::kGantry) return start;
  PlacedLink parent, parent_default;
  if (link.parent) {
    const TreeLink& on = tree.links[*link.parent];
    parent = place_by(on, placements);
    parent_default = default_place(layout, on);
  }
  const PlaceInParent now = in_parent(link, own, parent);
  const PlaceInParent then = in_parent(link, default_place(layout, link), parent_default);
  start.shift_P = now.p_PC - then.p_PC;
  start.turn_rad = wrapped(now.yaw_rad - then.yaw_rad);
  if (link.joint == LinkJoint::kSlider) {
    const JointSpec& spec = layout.sliders[layout.sliders.id_at(link.joint_index)];
    start.slide_m =
        (rotation_about_z(-parent_default.yaw_rad) * spec.axis_W.normalized()).dot(start.shift_P);
  }
  return start;
}

Eigen::Vector3d gantry_position_m(const PhysicsWorld& world, const TreeLink& link) {
  const BodySpec& child = world.layout().bodies[link.joint_child];
  const Eigen::Vector3d p_WC = world.position(link.joint_child);
  if (!link.joint_parent) return p_WC - child.p_WB;
  const BodySpec& parent = world.layout().bodies[*link.joint_parent];
  const Eigen::Vector3d start_P = rotation_about_z(-parent.yaw_rad) * (child.p_WB - parent.p_WB);
  return world.rotation(*link.joint_parent).transpose() *
             (p_WC - world.position(*link.joint_parent)) -
         start_P;
}

double carried_weight_n(const WorldLayout& layout, const LinkTree& tree, LinkId id,
                        double gravity_m_s2) {
  const auto assembly_of = [&](const TreeLink& link) {
    return layout.assembly_of[link.frame.index()];
  };
  double weight_n = 0.0;
  for (const TreeLink& link : tree.links) {
    if (!link.gravity || assembly_of(link) != assembly_of(tree.links[id])) continue;
    weight_n -= link.mass_kg * gravity_m_s2;
  }
  return weight_n;
}

}  // namespace parallax::harness
