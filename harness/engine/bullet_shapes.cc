#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "harness/engine/bullet_engine.h"
#include "harness/world/shapes.h"

namespace parallax::harness {
namespace {

void add_shapes_of(BulletWorld::Engine& engine, BodyId id) {
  const BodySpec& body = engine.layout.bodies[id];
  if (!body.collides) return;
  const PoseInLink& place = engine.tree.in_link[id.index()];
  for (const BodyShape& shape : body.shapes) {
    BulletShape& one = engine.shapes.emplace_back();
    one.side = &engine.rules.of(id);
    one.link = engine.layout.link_of[id.index()];
    one.form = shape.form;
    one.size_m = shape.size_m;
    one.hull = shape.hull;
    one.p_LS = place.p_LB + place.R_LB * shape.p_BS;
    one.R_LS = place.R_LB * shape_rotation(shape);
    one.radius_m = 0.5 * shape.size_m.norm();
    one.shape = make_bullet_shape(shape.form, shape.size_m, shape.hull.get());
    // The engine clips faces of polyhedra against each other, but only faces that it was told.
    if (!one.shape->isPolyhedral()) continue;
    static_cast<btPolyhedralConvexShape&>(*one.shape).initializePolyhedralFeatures();
  }
}

void find_principal_axes(const TreeLink& link, BulletLink& out) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(link.I_C_kg_m2);
  out.moments_kg_m2 = solver.eigenvalues();
  out.R_LC = solver.eigenvectors();
  if (out.R_LC.determinant() < 0.0) out.R_LC.col(2) *= -1.0;
}

void add_links(BulletWorld::Engine& engine) {
  for (const TreeLink& link : engine.tree.links) {
    BulletLink& one = engine.links.emplace_back();
    find_principal_axes(link, one);
    one.compound = std::make_unique<btCompoundShape>();
    engine.masses_kg.push_back(link.mass_kg);
  }
  for (const BulletShape& shape : engine.shapes) {
    if (!shape.link) continue;
    const TreeLink& link = engine.tree.links[*shape.link];
    BulletLink& one = engine.links[shape.link->index()];
    const Eigen::Matrix3d R_CL = one.R_LC.transpose();
    one.compound->addChildShape(to_bullet(R_CL * (shape.p_LS - link.p_LC), R_CL * shape.R_LS),
                                shape.shape.get());
    one.shapes.push_back(&shape);
  }
}

}  // namespace

std::unique_ptr<btConvexShape> make_bullet_shape(ShapeForm form, const Eigen::Vector3d& size_m,
                                                 const ConvexHull* hull) {
  const Eigen::Vector3d half_m = 0.5 * size_m;
  std::unique_ptr<btConvexShape> shape;
  switch (form) {
    case ShapeForm::kSphere:
      return std::make_unique<btSphereShape>(half_m.x());
    case ShapeForm::kCapsule:
      return std::make_unique<btCapsuleShapeZ>(half_m.x(), std::max(size_m.z() - size_m.x(), 0.0));
    case ShapeForm::kBox:
      shape = std::make_unique<btBoxShape>(to_bullet(half_m));
      break;
    case ShapeForm::kCylinder:
      shape = std::make_unique<btCylinderShapeZ>(to_bullet(half_m));
      break;
    case ShapeForm::kHull: {
      auto own = std::make_unique<btConvexHullShape>();
      for (const Eigen::Vector3d& vertex : hull->vertices) own->addPoint(to_bullet(vertex), false);
      own->recalcLocalAabb();
      shape = std::move(own);
      break;
    }
  }
  shape->setMargin(0.0);  // of a ball or a capsule it is the radius
  return shape;
}

BulletWorld::Engine::Engine(const EngineInput& input)
    : EngineState(input.spec, input.layout), tree(input.tree) {
  in_link = tree.in_link;
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    add_shapes_of(*this, layout.bodies.id_at(i));
  }
  add_links(*this);
  floor.side = &rules.floor();
  floor_shapes = {&floor};
  for (const BulletShape& shape : shapes) {
    auto& own = static_shapes.emplace_back();
    if (!shape.link) own.push_back(&shape);
  }
  slider_links.resize(layout.sliders.size());
  hinge_links.resize(layout.hinges.size());
  gantry_links.resize(layout.gantries.size());
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    const LinkId id = tree.links.id_at(i);
    const TreeLink& link = tree.links[id];
    if (link.joint == LinkJoint::kSlider) slider_links[link.joint_index] = id;
    if (link.joint == LinkJoint::kHinge) hinge_links[link.joint_index] = id;
    if (link.joint == LinkJoint::kGantry) gantry_links[link.joint_index] = id;
  }
}

BulletWorld::Engine::~Engine() = default;

}  // namespace parallax::harness
