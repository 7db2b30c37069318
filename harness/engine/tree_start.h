#pragma once

#include <Eigen/Core>
#include <span>

#include "harness/engine/link_tree.h"
#include "harness/engine/physics_world.h"

// Engines of joint coordinates share the tree and these: starts, gantries and their springs.

namespace parallax::harness {

/// The pose that a start gives a link, in the world and in the coordinates of its joint.
struct LinkStart {
  Eigen::Vector3d p_WL = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;
  double slide_m = 0.0;                               // of a slider
  Eigen::Vector3d shift_P = Eigen::Vector3d::Zero();  // of a gantry, along the axes of the parent
  double turn_rad = 0.0;                              // likewise, within half a turn
};

/// A hinge has nothing here: it begins where it is by default, since no start sets it.
LinkStart start_of(const WorldLayout& layout, const LinkTree& tree, LinkId id,
                   std::span<const Placement> placements);

/// PhysicsWorld::gantry_position_m, of the gantry that moves `link`.
Eigen::Vector3d gantry_position_m(const PhysicsWorld& world, const TreeLink& link);

/// The weight, as specified, of all that hangs together with the link [N].
double carried_weight_n(const WorldLayout& layout, const LinkTree& tree, LinkId id,
                        double gravity_m_s2);

}  // namespace parallax::harness
