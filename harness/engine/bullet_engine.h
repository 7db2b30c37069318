#pragma once

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <btBulletDynamicsCommon.h>

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "harness/engine/bullet_joints.h"
#include "harness/engine/bullet_world.h"
#include "harness/engine/engine_module.h"

namespace parallax::harness {

inline btVector3 to_bullet(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
inline Eigen::Vector3d from_bullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
inline Eigen::Matrix3d from_bullet(const btMatrix3x3& R) {
  Eigen::Matrix3d out;
  for (int row = 0; row < 3; ++row) out.row(row) = from_bullet(R[row]);
  return out;
}
inline btTransform to_bullet(const Eigen::Vector3d& p, const Eigen::Matrix3d& R) {
  return btTransform(
      btMatrix3x3(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)),
      to_bullet(p));
}

/// One shape of the world, or the floor. Its frame S is given in its link, or in the world where it
/// is static.
struct BulletShape {
  const ContactSide* side = nullptr;
  std::optional<LinkId> link;  // none: static
  ShapeForm form = ShapeForm::kBox;
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();
  std::shared_ptr<const ConvexHull> hull;
  Eigen::Vector3d p_LS = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_LS = Eigen::Matrix3d::Identity();
  double radius_m = 0.0;                 // of the sphere round it, about its origin
  std::unique_ptr<btConvexShape> shape;  // null: the floor
};

/// A shape of the engine without the margin that it would round edges by.
std::unique_ptr<btConvexShape> make_bullet_shape(ShapeForm form, const Eigen::Vector3d& size_m,
                                                 const ConvexHull* hull);

/// A link as the engine has it: its frame C lies along the principal axes of inertia, in the
/// centre of mass.
struct BulletLink {
  Eigen::Matrix3d R_LC = Eigen::Matrix3d::Identity();
  Eigen::Vector3d moments_kg_m2 = Eigen::Vector3d::Zero();
  std::unique_ptr<btCompoundShape> compound;
  std::vector<const BulletShape*> shapes;  // by child of the compound
  // In the current start:
  btMultiBody* body = nullptr;
  int link = -1;        // of `body`; -1: its base
  int first_axis = -1;  // the first of the links of `body` that make its joint
  // Its present pose:
  Eigen::Vector3d p_WL = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_WL = Eigen::Matrix3d::Identity();
};

/// The rows of a joint that can be told something.
struct BulletMotors {
  JointRow* motor = nullptr;  // of a slider or a hinge; of a gantry along x
  JointRow* side = nullptr;   // of a gantry: along y, z and about z
  JointRow* height = nullptr;
  JointRow* turn = nullptr;
};

class BulletStage;

/// The state behind BulletWorld. The frame of a link is that of the tree.
struct BulletWorld::Engine final : EngineState {
  LinkTree tree;
  std::vector<BulletShape> shapes;
  std::vector<BulletLink> links;                                // by LinkId
  std::vector<LinkId> slider_links, hinge_links, gantry_links;  // by SliderId, ...
  std::vector<BulletMotors> sliders, hinges, gantries;          // likewise
  BulletShape floor;
  std::vector<const BulletShape*> floor_shapes;                // the floor alone
  std::vector<std::vector<const BulletShape*>> static_shapes;  // by shape; empty: it can move
  std::unique_ptr<BulletStage> stage;

  explicit Engine(const EngineInput& input);
  ~Engine() override;
};

/// All of the engine's objects, made anew for each start: what Bullet keeps from step to step
/// (trees of boxes, contacts, impulses) would let a run depend on the one before it.
class BulletStage {
 public:
  BulletStage(BulletWorld::Engine& engine, std::span<const Placement> placements);
  ~BulletStage();
  BulletStage(const BulletStage&) = delete;
  BulletStage& operator=(const BulletStage&) = delete;

  /// Finds contacts as bodies stand and drops those of pairs that never touch.
  void find_contacts();
  /// The rest of a step, with the contacts that were found.
  void advance();
  /// Contacts of the last find_contacts.
  const std::vector<btPersistentManifold*>& contacts() const { return contacts_; }
  const std::vector<std::unique_ptr<btMultiBody>>& bodies() const { return bodies_; }
  void update_places();

 private:
  struct Filter;
  /// The engine's world, which shows the stages of its step.
  class World final : public btMultiBodyDynamicsWorld {
   public:
    using btMultiBodyDynamicsWorld::btMultiBodyDynamicsWorld;
    void solve_and_move(double step_s);
  };

  void add_floor();
  void add_static_shapes();
  void add_link(LinkId id, std::span<const Placement> placements);
  btMultiBody* add_free_root(LinkId id, std::span<const Placement> placements, int count);
  int count_axes(LinkId id) const;
  void add_axes(LinkId id, int& next);
  void add_collider(LinkId id);
  void add_rows(LinkId id);
  void add_followers();
  JointRow& add_row(const RowSpec& spec, LinkId id, int axis);
  void push_weights();

  BulletWorld::Engine& engine_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btMultiBodyConstraintSolver solver_;
  std::unique_ptr<Filter> filter_;
  std::unique_ptr<btCollisionAlgorithmCreateFunc> floor_maker_;
  btStaticPlaneShape floor_shape_;
  std::vector<std::unique_ptr<btMultiBody>> bodies_;
  std::vector<std::unique_ptr<btCollisionObject>> objects_;
  std::vector<btMultiBodyLinkCollider*> colliders_;  // by LinkId
  std::vector<std::unique_ptr<JointRow>> rows_;
  std::unique_ptr<World> world_;
  std::vector<btPersistentManifold*> contacts_;
  btAlignedObjectArray<btQuaternion> scratch_turns_;
  btAlignedObjectArray<btVector3> scratch_places_;
};

/// The shapes that a contact point is of.
struct BulletContact {
  const BulletShape *first, *second;
};
BulletContact shapes_at(const btPersistentManifold& manifold, const btManifoldPoint& point);

/// Teaches the dispatcher how shapes meet the floor. The result must outlive the contacts.
std::unique_ptr<btCollisionAlgorithmCreateFunc> register_floor(btCollisionDispatcher& dispatcher);

}  // namespace parallax::harness
