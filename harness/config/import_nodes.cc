#include "harness/config/import_nodes.h"

#include <vector>

namespace parallax::harness {
namespace {

using Corners = std::vector<Eigen::Vector3d>;

YamlNode corners_node(const Corners& corners, const base::SourceRange& range) {
  auto list = node_at(YamlNode::Kind::kList, range);
  for (const Eigen::Vector3d& corner : corners) {
    auto& item = list.items.emplace_back(node_at(YamlNode::Kind::kList, range));
    for (const double x : {corner.x(), corner.y(), corner.z()}) {
      item.items.push_back(node_at(YamlNode::Kind::kScalar, range, fmt::format("{}", x)));
    }
  }
  return list;
}

/// A hull is given by a mesh or by its corners.
YamlNode shape_node(const BodyShape& shape, const MeshUse* mesh, const Corners* corners,
                    const base::SourceRange& range) {
  MapNode out(range);
  MapNode file(range);
  if (mesh != nullptr) {
    file.text(Key::kFile, mesh->file);
    file.vector(Key::kScale, mesh->scale);
  }
  const double radius_m = 0.5 * shape.size_m.x(), length_m = shape.size_m.z();
  MapNode round(range);
  round.number(Key::kRadiusM, radius_m);
  switch (shape.form) {
    case ShapeForm::kBox:
      out.vector(Key::kSizeM, shape.size_m);
      break;
    case ShapeForm::kSphere:
      out.put(Key::kSphere, round.take());
      break;
    case ShapeForm::kCylinder:
      round.number(Key::kLengthM, length_m);
      out.put(Key::kCylinder, round.take());
      break;
    case ShapeForm::kCapsule:
      round.number(Key::kLengthM, length_m - 2.0 * radius_m);
      out.put(Key::kCapsule, round.take());
      break;
    case ShapeForm::kHull:
      if (corners != nullptr) {
        out.put(Key::kHull, corners_node(*corners, range));
      } else {
        out.put(Key::kMesh, file.take());
      }
      break;
  }
  out.vector(Key::kAtM, shape.p_BS);
  out.number_unless_zero(Key::kYawRad, shape.yaw_rad);
  out.number_unless_zero(Key::kPitchRad, shape.pitch_rad);
  out.number_unless_zero(Key::kRollRad, shape.roll_rad);
  return out.take();
}

}  // namespace

YamlNode body_node(const ImportedBody& made, const base::SourceRange& range) {
  const BodySpec& body = made.spec;
  MapNode out(range);
  auto shapes = node_at(YamlNode::Kind::kList, range);
  for (std::size_t i = 0; i < body.shapes.size(); ++i) {
    const auto mesh = made.meshes.find(i);
    const auto hull = made.hulls.find(i);
    shapes.items.push_back(shape_node(body.shapes[i],
                                      mesh == made.meshes.end() ? nullptr : &mesh->second,
                                      hull == made.hulls.end() ? nullptr : &hull->second, range));
  }
  out.put(Key::kShapes, std::move(shapes));
  out.number_unless_zero(Key::kMassKg, body.mass_kg);
  if (body.inertia) {
    MapNode inertia(range);
    inertia.vector(Key::kCentreM, body.inertia->p_BC);
    const Eigen::Matrix3d& I = body.inertia->I_C_kg_m2;
    inertia.numbers(Key::kMomentsKgM2, {I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2)});
    out.put(Key::kInertia, inertia.take());
  }
  out.text(Key::kMaterial, body.material);
  out.vector(Key::kPositionM, body.p_WB);
  out.number_unless_zero(Key::kYawRad, body.yaw_rad);
  if (!body.collides) out.word(Key::kCollides, "false");
  out.text(Key::kApart, body.apart);
  return out.take();
}

YamlNode joint_node(const JointSpec& joint, const base::SourceRange& range) {
  MapNode out(range);
  out.text(Key::kParent, joint.parent.empty() ? "world" : joint.parent);
  out.text(Key::kChild, joint.child);
  if (joint.type == JointType::kFixed) {
    out.word(Key::kType, "fixed");
    return out.take();
  }
  out.vector(Key::kAxis, joint.axis_W);
  if (joint.type == JointType::kHinge) {
    out.word(Key::kType, "hinge");
    out.vector(Key::kAtM, joint.p_WA);
    out.stops(Key::kRangeRad, joint.low_rad, joint.high_rad);
    out.number_unless_zero(Key::kMaxTorqueNm, joint.max_torque_nm);
    out.number_unless_zero(Key::kDampingNmS, joint.damping_nm_s);
  } else {
    out.word(Key::kType, "slider");
    out.stops(Key::kRangeM, joint.low_m, joint.high_m);
    out.number_unless_zero(Key::kMaxForceN, joint.max_force_n);
    out.number_unless_zero(Key::kDampingNSM, joint.damping_n_s_m);
  }
  if (joint.follows) {
    MapNode follows(range);
    follows.text(Key::kJoint, joint.follows->leader);
    follows.number(Key::kRatio, joint.follows->ratio);
    out.put(Key::kFollows, follows.take());
  }
  return out.take();
}

}  // namespace parallax::harness
