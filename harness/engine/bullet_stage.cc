// A start in Bullet: trees of links, what is static, and the rows of the joints.
//
// Each tree of the layout is one btMultiBody (Featherstone, "Robot Dynamics Algorithms", 1987). One
// that hangs on the world has a base that does not move. A gantry is a chain of axes, all but the
// last of them of links without mass: three that slide along the axes of the parent, one that turns
// upright and, on springs, two that lean. All axes of a joint have the orientation of the link that
// it moves, so that each is a vector in that frame.
//
// Cost of a start: linear in the shapes and links.

#include <algorithm>
#include <cmath>

#include "harness/engine/bullet_engine.h"
#include "harness/engine/tree_start.h"

namespace parallax::harness {
namespace {

constexpr int kStatic = -1;  // in the place of a LinkId

btQuaternion turn_of(const Eigen::Matrix3d& R) {
  const Eigen::Quaterniond q(R);
  return {q.x(), q.y(), q.z(), q.w()};
}

struct LinkPose {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
};

LinkPose default_pose(const WorldLayout& layout, BodyId id) {
  const BodySpec& body = layout.bodies[id];
  return {body.p_WB, rotation_about_z(body.yaw_rad)};
}

/// The frame C of a link by default, in the world.
LinkPose default_centre(const BulletWorld::Engine& engine, LinkId id) {
  const TreeLink& link = engine.tree.links[id];
  const LinkPose frame = default_pose(engine.layout, link.frame);
  return {frame.p + frame.R * link.p_LC, frame.R * engine.links[id.index()].R_LC};
}

struct Axis {
  bool turns = false;
  Eigen::Vector3d axis_W, p_W;  // by default; where it slides the point is of no account
};

/// The axes of the joint that moves a link, from the parent on.
std::vector<Axis> axes_of(const BulletWorld::Engine& engine, LinkId id) {
  const WorldLayout& layout = engine.layout;
  const TreeLink& link = engine.tree.links[id];
  const Eigen::Vector3d p_WC = default_centre(engine, id).p;
  switch (link.joint) {
    case LinkJoint::kFree:
      return {};
    case LinkJoint::kSlider: {
      const JointSpec& spec = layout.sliders[layout.sliders.id_at(link.joint_index)];
      return {{false, spec.axis_W.normalized(), p_WC}};
    }
    case LinkJoint::kHinge: {
      const JointSpec& spec = layout.hinges[layout.hinges.id_at(link.joint_index)];
      return {{true, spec.axis_W.normalized(), spec.p_WA}};
    }
    case LinkJoint::kGantry:
      break;
  }
  LinkPose parent;
  if (link.parent) parent = default_pose(layout, engine.tree.links[*link.parent].frame);
  const Eigen::Matrix3d R_WL = default_pose(layout, link.frame).R;
  std::vector<Axis> axes;
  for (int i = 0; i < 3; ++i) axes.push_back({false, parent.R.col(i), p_WC});
  axes.push_back({true, Eigen::Vector3d::UnitZ(), p_WC});
  if (layout.gantries[layout.gantries.id_at(link.joint_index)].suspension) {
    axes.push_back({true, R_WL.col(1), p_WC});
    axes.push_back({true, R_WL.col(0), p_WC});
  }
  return axes;
}

}  // namespace

/// Leaves out pairs that hang together, or of which neither moves.
struct BulletStage::Filter final : btOverlapFilterCallback {
  explicit Filter(const BulletWorld::Engine& its_engine) : engine(its_engine) {}
  bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
    const int one = link_of(*a), other = link_of(*b);
    if (one == kStatic && other == kStatic) return false;
    return one == kStatic || other == kStatic || assembly(one) != assembly(other);
  }
  static int link_of(const btBroadphaseProxy& proxy) {
    return static_cast<const btCollisionObject*>(proxy.m_clientObject)->getUserIndex();
  }
  std::uint32_t assembly(int link) const {
    const LinkId id = engine.tree.links.id_at(static_cast<std::size_t>(link));
    return engine.layout.assembly_of[engine.tree.links[id].frame.index()];
  }
  const BulletWorld::Engine& engine;
};

void BulletStage::World::solve_and_move(double step_s) {
  calculateSimulationIslands();
  getSolverInfo().m_timeStep = step_s;
  solveConstraints(getSolverInfo());
  integrateTransforms(step_s);
}

BulletStage::BulletStage(BulletWorld::Engine& engine, std::span<const Placement> placements)
    : engine_(engine),
      dispatcher_(&configuration_),
      filter_(std::make_unique<Filter>(engine)),
      floor_shape_(btVector3(0.0, 0.0, 1.0), 0.0),
      colliders_(engine.links.size(), nullptr),
      world_(std::make_unique<World>(&dispatcher_, &broadphase_, &solver_, &configuration_)) {
  // The engine turns round shapes that touch a little, to find more points than one.
  constexpr int kTurns = 4, kFewContacts = 4;
  configuration_.setConvexConvexMultipointIterations(kTurns, kFewContacts);
  floor_maker_ = register_floor(dispatcher_);
  broadphase_.getOverlappingPairCache()->setOverlapFilterCallback(filter_.get());

  // Rounds are made until no row changes a speed by more than this.
  constexpr double kSameSpeed = 1e-8;
  btContactSolverInfo& info = world_->getSolverInfo();
  info.m_numIterations = 1000;
  info.m_leastSquaresResidualThreshold = kSameSpeed * kSameSpeed;
  info.m_minimumSolverBatchSize = 0;  // each island by itself
  info.m_splitImpulse = 0;
  info.m_erp = engine.solver.erp;
  info.m_erp2 = engine.solver.contact_erp.value_or(engine.solver.erp);
  info.m_globalCfm = engine.solver.contact_cfm.value_or(engine.solver.cfm);
  info.m_solverMode |= SOLVER_USE_ARTICULATED_WARMSTARTING;

  add_floor();
  add_static_shapes();
  for (BulletLink& link : engine.links) link.body = nullptr;
  for (const LinkId id : engine.tree.order) add_link(id, placements);
  engine.sliders.assign(engine.layout.sliders.size(), {});
  engine.hinges.assign(engine.layout.hinges.size(), {});
  engine.gantries.assign(engine.layout.gantries.size(), {});
  for (const LinkId id : engine.tree.order) add_rows(id);
  add_followers();
  update_places();
}

BulletStage::~BulletStage() = default;

void BulletStage::add_floor() {
  auto& floor = objects_.emplace_back(std::make_unique<btCollisionObject>());
  floor->setCollisionShape(&floor_shape_);
  floor->setUserIndex(kStatic);
  floor->setUserPointer(&engine_.floor_shapes);
  world_->addCollisionObject(floor.get());
}

void BulletStage::add_static_shapes() {
  for (std::size_t i = 0; i < engine_.shapes.size(); ++i) {
    const BulletShape& shape = engine_.shapes[i];
    if (shape.link) continue;
    auto& object = objects_.emplace_back(std::make_unique<btCollisionObject>());
    object->setCollisionShape(shape.shape.get());
    object->setWorldTransform(to_bullet(shape.p_LS, shape.R_LS));
    object->setUserIndex(kStatic);
    object->setUserPointer(&engine_.static_shapes[i]);
    world_->addCollisionObject(object.get());
  }
}

int BulletStage::count_axes(LinkId id) const {
  int count = static_cast<int>(axes_of(engine_, id).size());
  for (std::size_t i = 0; i < engine_.tree.links.size(); ++i) {
    const LinkId child = engine_.tree.links.id_at(i);
    if (engine_.tree.links[child].parent == id) count += count_axes(child);
  }
  return count;
}

void BulletStage::add_link(LinkId id, std::span<const Placement> placements) {
  const TreeLink& link = engine_.tree.links[id];
  if (link.parent) return;  // with its root
  const bool is_free = link.joint == LinkJoint::kFree;
  btMultiBody* body = nullptr;
  if (is_free) {
    body = add_free_root(id, placements, count_axes(id));
  } else {
    bodies_.push_back(
        std::make_unique<btMultiBody>(count_axes(id), 0.0, btVector3(0.0, 0.0, 0.0), true, false));
    body = bodies_.back().get();
    body->setBaseWorldTransform(btTransform::getIdentity());
  }
  engine_.links[id.index()].body = body;
  int next = 0;
  if (!is_free) add_axes(id, next);
  for (const LinkId other : engine_.tree.order) {
    const auto& parent = engine_.tree.links[other].parent;
    if (!parent || engine_.links[parent->index()].body != body) continue;
    engine_.links[other.index()].body = body;
    add_axes(other, next);
  }
  body->finalizeMultiDof();
  body->setLinearDamping(0.0);
  body->setAngularDamping(0.0);
  body->setMaxCoordinateVelocity(1e12);
  body->setHasSelfCollision(false);
  for (const LinkId other : engine_.tree.order) {
    if (engine_.links[other.index()].body != body) continue;
    add_collider(other);
    const TreeLink& part = engine_.tree.links[other];
    const LinkStart start = start_of(engine_.layout, engine_.tree, other, placements);
    const int first = engine_.links[other.index()].first_axis;
    if (part.joint == LinkJoint::kSlider) body->setJointPos(first, start.slide_m);
    if (part.joint != LinkJoint::kGantry) continue;
    for (int i = 0; i < 3; ++i) body->setJointPos(first + i, start.shift_P[i]);
    body->setJointPos(first + 3, start.turn_rad);
  }
  world_->addMultiBody(body);
}

btMultiBody* BulletStage::add_free_root(LinkId id, std::span<const Placement> placements,
                                        int count) {
  const TreeLink& link = engine_.tree.links[id];
  BulletLink& one = engine_.links[id.index()];
  const double wanted_kg =
      engine_.layout.is_free[link.frame.index()] ? placements[link.frame.index()].mass_kg : 0.0;
  const double mass_kg = wanted_kg > 0.0 ? wanted_kg : link.mass_kg;
  engine_.masses_kg[id.index()] = mass_kg;
  const Eigen::Vector3d moments = mass_kg / link.mass_kg * one.moments_kg_m2;
  bodies_.push_back(
      std::make_unique<btMultiBody>(count, mass_kg, to_bullet(moments), false, false));
  const LinkStart start = start_of(engine_.layout, engine_.tree, id, placements);
  const Eigen::Matrix3d R_WL = rotation_about_z(start.yaw_rad);
  bodies_.back()->setBaseWorldTransform(to_bullet(start.p_WL + R_WL * link.p_LC, R_WL * one.R_LC));
  one.link = one.first_axis = -1;
  return bodies_.back().get();
}

/// Adds the links of the engine that make a joint and what it moves.
void BulletStage::add_axes(LinkId id, int& next) {
  const TreeLink& link = engine_.tree.links[id];
  BulletLink& one = engine_.links[id.index()];
  LinkPose parent;  // frame C of it
  int on = -1;
  if (link.parent) {
    parent = default_centre(engine_, *link.parent);
    on = engine_.links[link.parent->index()].link;
  }
  const LinkPose own = default_centre(engine_, id);
  const Eigen::Matrix3d R_CW = own.R.transpose();
  const std::vector<Axis> axes = axes_of(engine_, id);
  one.first_axis = next;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const Axis& axis = axes[i];
    const bool is_first = i == 0, is_last = i + 1 == axes.size();
    const double mass_kg = is_last ? link.mass_kg : 0.0;
    const btVector3 moments = is_last ? to_bullet(one.moments_kg_m2) : btVector3(0.0, 0.0, 0.0);
    const btQuaternion turn = is_first ? turn_of(R_CW * parent.R) : btQuaternion::getIdentity();
    // All but the first begin in the centre of mass, where the first leads.
    const btVector3 to_pivot =
        is_first ? to_bullet(parent.R.transpose() * (axis.p_W - parent.p)) : btVector3(0, 0, 0);
    const btVector3 to_centre = to_bullet(R_CW * (own.p - axis.p_W));
    const btVector3 direction = to_bullet(R_CW * axis.axis_W);
    if (axis.turns) {
      one.body->setupRevolute(next, mass_kg, moments, on, turn, direction, to_pivot, to_centre,
                              true);
    } else {
      one.body->setupPrismatic(next, mass_kg, moments, on, turn, direction, to_pivot, to_centre,
                               true);
    }
    on = one.link = next++;
  }
}

void BulletStage::add_collider(LinkId id) {
  BulletLink& one = engine_.links[id.index()];
  auto owned = std::make_unique<btMultiBodyLinkCollider>(one.body, one.link);
  btMultiBodyLinkCollider* const collider = owned.get();
  objects_.push_back(std::move(owned));
  colliders_[id.index()] = collider;
  collider->setCollisionShape(one.compound.get());
  collider->setUserIndex(static_cast<int>(id.index()));
  collider->setUserPointer(&one.shapes);
  collider->setActivationState(DISABLE_DEACTIVATION);
  if (one.link < 0) {
    one.body->setBaseCollider(collider);
  } else {
    one.body->getLink(one.link).m_collider = collider;
  }
  world_->addCollisionObject(collider);
}

void BulletStage::find_contacts() {
  world_->performDiscreteCollisionDetection();
  contacts_.clear();
  for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
    btPersistentManifold* const manifold = dispatcher_.getManifoldByIndexInternal(i);
    for (int k = manifold->getNumContacts() - 1; k >= 0; --k) {
      btManifoldPoint& point = manifold->getContactPoint(k);
      const BulletContact at = shapes_at(*manifold, point);
      if (ContactRules::never_collide(*at.first->side, *at.second->side)) {
        manifold->removeContactPoint(k);
        continue;
      }
      point.m_combinedFriction = engine_.rules.friction(*at.first->side, *at.second->side);
      point.m_combinedRestitution = 0.0;
    }
    if (manifold->getNumContacts() > 0) contacts_.push_back(manifold);
  }
}

void BulletStage::push_weights() {
  for (std::size_t i = 0; i < engine_.links.size(); ++i) {
    const TreeLink& link = engine_.tree.links[engine_.tree.links.id_at(i)];
    if (!link.gravity) continue;
    const BulletLink& one = engine_.links[i];
    const btVector3 weight_n(0.0, 0.0, engine_.masses_kg[i] * engine_.solver.gravity_m_s2);
    if (one.link < 0) {
      one.body->addBaseForce(weight_n);
    } else {
      one.body->addLinkForce(one.link, weight_n);
    }
  }
}

void BulletStage::advance() {
  push_weights();
  world_->solve_and_move(engine_.solver.timestep_s);
  for (const auto& body : bodies_) body->clearForcesAndTorques();
  update_places();
}

void BulletStage::update_places() {
  for (const auto& body : bodies_) {
    const int places = body->getNumLinks() + 1;
    scratch_turns_.resize(places);
    scratch_places_.resize(places);
    body->forwardKinematics(scratch_turns_, scratch_places_);
    body->updateCollisionObjectWorldTransforms(scratch_turns_, scratch_places_);
  }
  for (std::size_t i = 0; i < engine_.links.size(); ++i) {
    BulletLink& one = engine_.links[i];
    const btTransform at = one.link < 0 ? one.body->getBaseWorldTransform()
                                        : one.body->getLink(one.link).m_cachedWorldTransform;
    one.R_WL = from_bullet(at.getBasis()) * one.R_LC.transpose();
    one.p_WL = from_bullet(at.getOrigin()) -
               one.R_WL * engine_.tree.links[engine_.tree.links.id_at(i)].p_LC;
  }
}

}  // namespace parallax::harness
