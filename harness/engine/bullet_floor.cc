// Contacts of shapes with the floor: every corner of a box or a hull, the lowest point of a ball,
// of the ends of a capsule and of the rims of a cylinder, and four points of each rim that keep
// their places on it. Of those near the floor the engine's manifold keeps four: the deepest, and
// those that span the most. Bullet by itself finds one point a step, so that things rock until it
// has collected enough.

#include <BulletCollision/CollisionDispatch/btActivatingCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include <array>
#include <cmath>

#include "harness/engine/bullet_engine.h"

namespace parallax::harness {
namespace {

/// Calls `touch(p_W)` with each point of the shape that can be its lowest.
template <typename TouchPoint>
void visit_low_points(const btConvexShape& shape, const btTransform& at, const TouchPoint& touch) {
  const btVector3 down(0.0, 0.0, -1.0);
  switch (shape.getShapeType()) {
    case BOX_SHAPE_PROXYTYPE: {
      const auto& box = static_cast<const btBoxShape&>(shape);
      for (int i = 0; i < box.getNumVertices(); ++i) {
        btVector3 corner;
        box.getVertex(i, corner);
        touch(at * corner);
      }
      return;
    }
    case SPHERE_SHAPE_PROXYTYPE:
      touch(at.getOrigin() + static_cast<const btSphereShape&>(shape).getRadius() * down);
      return;
    case CAPSULE_SHAPE_PROXYTYPE: {
      const auto& capsule = static_cast<const btCapsuleShape&>(shape);
      for (const double end : {-capsule.getHalfHeight(), capsule.getHalfHeight()}) {
        touch(at * btVector3(0.0, 0.0, end) + capsule.getRadius() * down);
      }
      return;
    }
    case CYLINDER_SHAPE_PROXYTYPE: {
      const btVector3 half = static_cast<const btCylinderShape&>(shape).getHalfExtentsWithMargin();
      const btVector3 down_S = at.getBasis().transpose() * down;
      const double slant = std::hypot(down_S.x(), down_S.y());
      for (const double end : {-half.z(), half.z()}) {
        for (const auto& [x, y] : {std::array{1.0, 0.0}, {0.0, 1.0}, {-1.0, 0.0}, {0.0, -1.0}}) {
          touch(at * btVector3(half.x() * x, half.x() * y, end));
        }
        if (slant == 0.0) continue;
        touch(at * btVector3(half.x() * down_S.x() / slant, half.x() * down_S.y() / slant, end));
      }
      return;
    }
    default: {
      const auto& hull = static_cast<const btConvexHullShape&>(shape);
      for (int i = 0; i < hull.getNumPoints(); ++i) touch(at * hull.getScaledPoint(i));
    }
  }
}

bool is_floor(const btCollisionObjectWrapper& object) {
  return object.getCollisionShape()->getShapeType() == STATIC_PLANE_PROXYTYPE;
}

class FloorAlgorithm final : public btActivatingCollisionAlgorithm {
 public:
  FloorAlgorithm(const btCollisionAlgorithmConstructionInfo& info,
                 const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b)
      : btActivatingCollisionAlgorithm(info),
        manifold_(m_dispatcher->getNewManifold(a->getCollisionObject(), b->getCollisionObject())) {}
  ~FloorAlgorithm() override { m_dispatcher->releaseManifold(manifold_); }
  FloorAlgorithm(const FloorAlgorithm&) = delete;
  FloorAlgorithm& operator=(const FloorAlgorithm&) = delete;

  void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                        const btDispatcherInfo& /*info*/, btManifoldResult* out) override {
    out->setPersistentManifold(manifold_);
    if (is_floor(*a)) {
      meet_floor(*b, -1.0, *out);
    } else {
      meet_floor(*a, 1.0, *out);
    }
    out->refreshContactPoints();
  }
  double calculateTimeOfImpact(btCollisionObject* /*a*/, btCollisionObject* /*b*/,
                               const btDispatcherInfo& /*info*/,
                               btManifoldResult* /*out*/) override {
    return 1.0;
  }
  void getAllContactManifolds(btManifoldArray& all) override { all.push_back(manifold_); }

 private:
  /// `up`: 1 where the floor is the second of the pair, so that normals point away from it, else
  /// -1.
  void meet_floor(const btCollisionObjectWrapper& object, double up, btManifoldResult& out) const {
    const auto& shape = static_cast<const btConvexShape&>(*object.getCollisionShape());
    visit_low_points(shape, object.getWorldTransform(), [&](const btVector3& p_W) {
      if (p_W.z() >= manifold_->getContactBreakingThreshold()) return;
      const btVector3 on_floor(p_W.x(), p_W.y(), 0.0);
      out.addContactPoint({0.0, 0.0, up}, up > 0.0 ? on_floor : p_W, p_W.z());
    });
  }

  btPersistentManifold* manifold_;
};

struct FloorMaker final : btCollisionAlgorithmCreateFunc {
  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper* a,
                                                 const btCollisionObjectWrapper* b) override {
    void* const memory =
        info.m_dispatcher1->allocateCollisionAlgorithm(static_cast<int>(sizeof(FloorAlgorithm)));
    return new (memory) FloorAlgorithm(info, a, b);
  }
};

}  // namespace

std::unique_ptr<btCollisionAlgorithmCreateFunc> register_floor(btCollisionDispatcher& dispatcher) {
  auto maker = std::make_unique<FloorMaker>();
  for (const int form : {BOX_SHAPE_PROXYTYPE, SPHERE_SHAPE_PROXYTYPE, CYLINDER_SHAPE_PROXYTYPE,
                         CAPSULE_SHAPE_PROXYTYPE, CONVEX_HULL_SHAPE_PROXYTYPE}) {
    dispatcher.registerCollisionCreateFunc(form, STATIC_PLANE_PROXYTYPE, maker.get());
    dispatcher.registerCollisionCreateFunc(STATIC_PLANE_PROXYTYPE, form, maker.get());
  }
  return maker;
}

}  // namespace parallax::harness
