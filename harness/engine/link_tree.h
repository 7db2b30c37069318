#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "harness/world/world_layout.h"

namespace parallax::harness {

enum class LinkJoint : std::uint8_t { kFree, kSlider, kHinge, kGantry };

/// A link as an engine of generalised coordinates wants it. Frame L is that of its first member,
/// at the default placement.
struct TreeLink {
  BodyId frame;
  std::optional<LinkId> parent;  // none: the world
  LinkJoint joint = LinkJoint::kFree;
  std::size_t joint_index = 0;  // in the store of its kind; of a free link without meaning
  std::string joint_name;
  BodyId joint_child;                  // as the joint names them
  std::optional<BodyId> joint_parent;  // none: the world
  double mass_kg = 0.0;
  Eigen::Vector3d p_LC = Eigen::Vector3d::Zero();       // centre of mass [m]
  Eigen::Matrix3d I_C_kg_m2 = Eigen::Matrix3d::Zero();  // about it, along the axes of L
  bool gravity = false;
};

inline Eigen::Matrix3d rotation_about_z(double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  Eigen::Matrix3d R;
  R << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
  return R;
}

/// Pose of body B in its link L (in the world for a static body).
struct PoseInLink {
  Eigen::Vector3d p_LB = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_LB = Eigen::Matrix3d::Identity();
};

struct LinkTree {
  base::Store<LinkId, TreeLink> links;  // as in the layout
  std::vector<LinkId> order;            // parents first
  std::vector<PoseInLink> in_link;      // by BodyId
};

/// A joint that no tree can have.
struct TreeProblem {
  std::string joint, message;
};

/// The tree of `layout`, or why its joints make none.
std::variant<LinkTree, TreeProblem> grow_tree(const WorldLayout& layout);

}  // namespace parallax::harness
