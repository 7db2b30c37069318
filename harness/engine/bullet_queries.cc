// Contacts, overlaps and rays in a world that Bullet steps.
//
// A probe is held against each shape whose surrounding sphere it can meet: boxes by our own
// function (box_contacts.cc), the floor by the lowest point, all else by the engine's GJK and EPA
// without margins. Rays are in closed form (shape_rays.cc). Cost: linear in the shapes, and for a
// ray in the faces of the hulls.

#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>

#include <algorithm>
#include <cmath>

#include "harness/engine/box_contacts.h"
#include "harness/engine/bullet_engine.h"
#include "harness/engine/shape_rays.h"
#include "harness/world/shapes.h"

namespace parallax::harness {
namespace {

using Engine = BulletWorld::Engine;

struct PlacedShape {
  Eigen::Vector3d p_WS;
  Eigen::Matrix3d R_WS;
};

PlacedShape place_of(const Engine& engine, const BulletShape& shape) {
  if (!shape.link) return {shape.p_LS, shape.R_LS};
  const BulletLink& link = engine.links[shape.link->index()];
  return {link.p_WL + link.R_WL * shape.p_LS, link.R_WL * shape.R_LS};
}

/// How deep two boxes are in each other; none if they do not meet.
std::optional<double> depth_of_boxes(const PlacedBox& a, const PlacedBox& b) {
  const BoxContacts found = contacts_of(a, b);
  std::optional<double> deepest;
  for (int i = 0; i < found.count; ++i) {
    const double depth_m = found.points[static_cast<std::size_t>(i)].depth_m;
    if (!deepest || depth_m > *deepest) deepest = depth_m;
  }
  return deepest;
}

/// Likewise of any shapes. Neither GJK nor EPA is sure of everything from where it begins, so what
/// seems to be apart is looked at from other directions, too.
std::optional<double> depth_of_shapes(const btConvexShape& a, const btTransform& at_a,
                                      const btConvexShape& b, const btTransform& at_b) {
  for (const btVector3& guess : {at_b.getOrigin() - at_a.getOrigin(), btVector3(1.0, 0.3, 0.2),
                                 btVector3(-0.2, -1.0, 0.3), btVector3(0.3, -0.2, -1.0)}) {
    if (guess.length2() == 0.0) continue;
    btGjkEpaSolver2::sResults found;
    if (btGjkEpaSolver2::Penetration(&a, at_a, &b, at_b, guess, found)) return -found.distance;
  }
  return std::nullopt;
}

PlacedBox box_of(const Engine& engine, const BulletShape& shape) {
  const PlacedShape at = place_of(engine, shape);
  return {at.p_WS, 0.5 * shape.size_m, at.R_WS};
}

bool is_box(const BulletShape& shape) {
  return shape.shape != nullptr && shape.form == ShapeForm::kBox;
}

}  // namespace

BulletContact shapes_at(const btPersistentManifold& manifold, const btManifoldPoint& point) {
  const auto shape = [](const btCollisionObject& object, int child) {
    const auto& all = *static_cast<const std::vector<const BulletShape*>*>(object.getUserPointer());
    return all.size() == 1 ? all.front() : all[static_cast<std::size_t>(child)];
  };
  return {shape(*manifold.getBody0(), point.m_index0), shape(*manifold.getBody1(), point.m_index1)};
}

std::optional<Overlap> BulletWorld::deepest_overlap() {
  engine_->stage->find_contacts();
  std::optional<Overlap> deepest;
  for (const btPersistentManifold* manifold : engine_->stage->contacts()) {
    for (int i = 0; i < manifold->getNumContacts(); ++i) {
      const btManifoldPoint& point = manifold->getContactPoint(i);
      const BulletContact at = shapes_at(*manifold, point);
      double depth_m = -point.getDistance();
      // The engine is off by a few micrometres if edges cross.
      if (is_box(*at.first) && is_box(*at.second)) {
        depth_m =
            depth_of_boxes(box_of(*engine_, *at.first), box_of(*engine_, *at.second)).value_or(0.0);
      }
      if (depth_m <= 0.0 || (deepest && depth_m <= deepest->depth_m)) continue;
      deepest = overlap_of(engine_->layout, *at.first->side, *at.second->side, depth_m);
    }
  }
  return deepest;
}

std::optional<Met> BulletWorld::deepest_met(const Probe& probe, const Sought& sought) const {
  const auto own = make_bullet_shape(probe.form, probe.size_m, probe.hull.get());
  const double radius_m = 0.5 * probe.size_m.norm();
  std::optional<Met> met;
  const auto meet = [&](const ContactSide& side, const std::optional<double>& depth_m) {
    if (depth_m && *depth_m >= 0.0 && (!met || *depth_m > met->metres)) met = Met{&side, *depth_m};
  };
  if (sought.includes(engine_->rules.floor())) {
    const double low_m = span(probe.form, probe.size_m, probe.hull.get(), probe.R_WS).first.z();
    meet(engine_->rules.floor(), -(probe.p_WS.z() + low_m));
  }
  for (const BulletShape& shape : engine_->shapes) {
    if (!sought.includes(*shape.side)) continue;
    const PlacedShape at = place_of(*engine_, shape);
    const double reach_m = radius_m + shape.radius_m;
    if ((at.p_WS - probe.p_WS).squaredNorm() > reach_m * reach_m) continue;
    if (probe.form == ShapeForm::kBox && shape.form == ShapeForm::kBox) {
      meet(*shape.side, depth_of_boxes({probe.p_WS, 0.5 * probe.size_m, probe.R_WS},
                                       {at.p_WS, 0.5 * shape.size_m, at.R_WS}));
    } else {
      meet(*shape.side, depth_of_shapes(*own, to_bullet(probe.p_WS, probe.R_WS), *shape.shape,
                                        to_bullet(at.p_WS, at.R_WS)));
    }
  }
  return met;
}

std::optional<Met> BulletWorld::first_met(const Eigen::Vector3d& from_W,
                                          const Eigen::Vector3d& to_W, const Sought& sought) const {
  const double length_m = (to_W - from_W).norm();
  if (length_m == 0.0) return std::nullopt;
  const Eigen::Vector3d direction = (to_W - from_W) / length_m;
  std::optional<Met> met;
  const auto meet = [&](const ContactSide& side, const std::optional<double>& way_m) {
    if (!way_m || *way_m > length_m || (met && *way_m >= met->metres)) return;
    met = Met{&side, *way_m};
  };
  if (sought.includes(engine_->rules.floor()) && direction.z() != 0.0) {
    const double way_m = -from_W.z() / direction.z();
    if (way_m >= 0.0) meet(engine_->rules.floor(), way_m);
  }
  for (const BulletShape& shape : engine_->shapes) {
    if (!sought.includes(*shape.side)) continue;
    const PlacedShape at = place_of(*engine_, shape);
    const Eigen::Vector3d d = at.p_WS - from_W;
    if (d.squaredNorm() - std::pow(d.dot(direction), 2) > shape.radius_m * shape.radius_m) continue;
    meet(*shape.side, ray_meets_shape(shape.form, shape.size_m, shape.hull.get(),
                                      at.R_WS.transpose() * -d, at.R_WS.transpose() * direction));
  }
  return met;
}

}  // namespace parallax::harness
