// The tree of links of a world: masses, centres and inertias, and the joint that moves each.
//
// Bodies that are fixed to each other are one link. A body's mass is spread over its shapes by
// volume unless it states its inertia. Parts are joined by the parallel axis theorem (Steiner):
// the mass-weighted centre, and the sum of the parts' inertias about it. Every link is moved by
// one joint at most, and links are put in order, parents first, by passes that place each link
// whose parent has its place; links that never get one are in a ring of joints, which is an
// error.
//
// Cost: linear in bodies and shapes; the order takes as many passes as the tree is deep, at
// worst.

#include "harness/engine/link_tree.h"

#include <fmt/format.h>

#include "harness/world/shapes.h"

namespace parallax::harness {
namespace {

struct PointMass {
  double mass_kg = 0.0;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();    // centre
  Eigen::Matrix3d I_C = Eigen::Matrix3d::Zero();  // about the centre
};

/// Moments about the middle along the shape's own axes, for a mass of 1.
Eigen::Vector3d unit_moments_m2(const BodyShape& shape) {
  const Eigen::Vector3d& size = shape.size_m;
  const double r2 = 0.25 * size.x() * size.x(), h = size.z();
  switch (shape.form) {
    case ShapeForm::kBox:
    case ShapeForm::kHull:  // which has its own
      break;
    case ShapeForm::kSphere:
      return Eigen::Vector3d::Constant(0.4 * r2);
    case ShapeForm::kCylinder:
      return {r2 / 4.0 + h * h / 12.0, r2 / 4.0 + h * h / 12.0, r2 / 2.0};
    case ShapeForm::kCapsule: {
      // A cylinder and two halves of a sphere, whose centres are 3/8 of the radius off their flats.
      const double radius = 0.5 * size.x(), length = h - size.x();
      const double ball = 4.0 / 3.0 * radius, rod = length;  // shares, but for pi r^2
      const double share = ball / (ball + rod);
      const double far = 0.5 * length + 0.375 * radius;
      const double cap_own_m2 = (0.4 - 0.375 * 0.375) * r2;
      const double across =
          share * (cap_own_m2 + far * far) + (1.0 - share) * (r2 / 4.0 + length * length / 12.0);
      return {across, across, share * 0.4 * r2 + (1.0 - share) * r2 / 2.0};
    }
  }
  const Eigen::Vector3d squares = size.cwiseProduct(size);
  return (Eigen::Vector3d::Constant(squares.sum()) - squares) / 12.0;
}

/// The inertia about a point that is `d` away from the centre, or of the whole seen from there.
Eigen::Matrix3d steiner(double mass_kg, const Eigen::Vector3d& d) {
  return mass_kg * (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose());
}

PointMass joined(const std::vector<PointMass>& parts) {
  PointMass all;
  for (const PointMass& part : parts) {
    all.mass_kg += part.mass_kg;
    all.p += part.mass_kg * part.p;
  }
  all.p /= all.mass_kg;
  for (const PointMass& part : parts) {
    all.I_C += part.I_C + steiner(part.mass_kg, part.p - all.p);
  }
  return all;
}

/// In the frame of the body.
PointMass mass_of(const BodySpec& body) {
  if (body.inertia) return {body.mass_kg, body.inertia->p_BC, body.inertia->I_C_kg_m2};
  double volume = 0.0;
  for (const BodyShape& shape : body.shapes) volume += volume_m3(shape);
  std::vector<PointMass> parts;
  for (const BodyShape& shape : body.shapes) {
    const double mass_kg = body.mass_kg * volume_m3(shape) / volume;
    const Eigen::Matrix3d R = shape_rotation(shape);
    Eigen::Matrix3d own = unit_moments_m2(shape).asDiagonal();
    if (shape.form == ShapeForm::kHull) own = shape.hull->moments_m2;
    parts.push_back({mass_kg, centroid_B(shape), mass_kg * R * own * R.transpose()});
  }
  return joined(parts);
}

class TreeGrower {
 public:
  explicit TreeGrower(const WorldLayout& layout) : layout_(layout) {}

  std::variant<LinkTree, TreeProblem> grow() {
    add_links();
    hang(layout_.sliders, LinkJoint::kSlider);
    hang(layout_.hinges, LinkJoint::kHinge);
    hang(layout_.gantries, LinkJoint::kGantry);
    if (!problem_) put_in_order();
    if (problem_) return *problem_;
    return std::move(tree_);
  }

 private:
  void add_links() {
    for (const BodySpec& body : layout_.bodies) {
      tree_.in_link.push_back({body.p_WB, rotation_about_z(body.yaw_rad)});
    }
    for (const Link& link : layout_.links) {
      TreeLink one;
      one.frame = link.members.front();
      const BodySpec& first = layout_.bodies[one.frame];
      const Eigen::Matrix3d R_LW = rotation_about_z(-first.yaw_rad);
      std::vector<PointMass> parts;
      for (const BodyId id : link.members) {
        const BodySpec& body = layout_.bodies[id];
        PoseInLink& pose = tree_.in_link[id.index()];
        pose.p_LB = R_LW * (body.p_WB - first.p_WB);
        pose.R_LB = rotation_about_z(body.yaw_rad - first.yaw_rad);
        PointMass part = mass_of(body);
        part.p = pose.p_LB + pose.R_LB * part.p;
        part.I_C = pose.R_LB * part.I_C * pose.R_LB.transpose();
        parts.push_back(part);
        one.gravity = one.gravity || body.gravity;
      }
      const PointMass whole = joined(parts);
      one.mass_kg = whole.mass_kg;
      one.p_LC = whole.p;
      one.I_C_kg_m2 = whole.I_C;
      tree_.links.add(std::move(one));
    }
  }

  template <typename Joints>
  void hang(const Joints& joints, LinkJoint kind) {
    std::size_t index = 0;
    for (const JointSpec& joint : joints) hang_one(joint, kind, index++);
  }

  void hang_one(const JointSpec& joint, LinkJoint kind, std::size_t index) {
    if (problem_) return;
    const auto child = layout_.link_of[layout_.find_body(joint.child)->index()];
    if (!child) {
      problem_ = TreeProblem{joint.name,
                             fmt::format("moves `{}`, which is part of the world", joint.child)};
      return;
    }
    TreeLink& link = tree_.links[*child];
    if (link.joint != LinkJoint::kFree) {
      problem_ = TreeProblem{
          joint.name,
          fmt::format("moves `{}`, which another joint moves already: no tree of joints",
                      joint.child)};
      return;
    }
    link.joint = kind;
    link.joint_index = index;
    link.joint_name = joint.name;
    link.joint_child = *layout_.find_body(joint.child);
    if (!joint.parent.empty()) {
      link.joint_parent = layout_.find_body(joint.parent);
      link.parent = layout_.link_of[link.joint_parent->index()];
    }
  }

  void put_in_order() {
    std::vector<bool> placed(tree_.links.size(), false);
    for (bool more = true; more;) {
      more = false;
      for (std::size_t i = 0; i < placed.size(); ++i) {
        const LinkId id = tree_.links.id_at(i);
        const auto& parent = tree_.links[id].parent;
        if (placed[i] || (parent && !placed[parent->index()])) continue;
        placed[i] = more = true;
        tree_.order.push_back(id);
      }
    }
    for (std::size_t i = 0; i < placed.size(); ++i) {
      if (placed[i]) continue;
      problem_ = TreeProblem{tree_.links[tree_.links.id_at(i)].joint_name,
                             "is part of a ring of joints: no tree of joints"};
      return;
    }
  }

  const WorldLayout& layout_;
  LinkTree tree_;
  std::optional<TreeProblem> problem_;
};

}  // namespace

std::variant<LinkTree, TreeProblem> grow_tree(const WorldLayout& layout) {
  return TreeGrower(layout).grow();
}

}  // namespace parallax::harness
