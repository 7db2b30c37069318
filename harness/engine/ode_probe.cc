#include <ode/ode.h>

#include <array>

#include "harness/engine/ode_engine.h"

namespace parallax::harness {
namespace {

struct ProbeSearch {
  const BodyMask& ignored;
  bool floor_counts = true;
  double best = 0.0;  // depth of an overlap, or distance along a ray
  bool nearest = false;
  const GeomInfo* found = nullptr;
};

/// One of the two is the probe, which carries no GeomInfo.
void visit(void* data, dGeomID a, dGeomID b) {
  auto& search = *static_cast<ProbeSearch*>(data);
  const dGeomID other = dGeomGetData(a) == nullptr ? b : a;
  const GeomInfo& info = info_of(other);
  if (info.body ? search.ignored[info.body->index()] : !search.floor_counts) return;
  std::array<dContactGeom, 8> contacts;
  const int count =
      dCollide(a, b, static_cast<int>(contacts.size()), contacts.data(), sizeof(dContactGeom));
  for (int i = 0; i < count; ++i) {
    const double depth = contacts[static_cast<std::size_t>(i)].depth;
    const bool better =
        search.found == nullptr || (search.nearest ? depth < search.best : depth > search.best);
    if (!better) continue;
    search.best = depth;
    search.found = &info;
  }
}

void visit_all(OdeWorld::Engine& engine, dGeomID probe, ProbeSearch& search) {
  for (dxSpace* const space : {engine.static_space, engine.movable_space}) {
    dSpaceCollide2(probe, reinterpret_cast<dGeomID>(space), &search, &visit);
  }
}

/// Finds the first thing that a ray meets.
void visit_ray(OdeWorld::Engine& engine, const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W,
               ProbeSearch& search) {
  const Eigen::Vector3d way = to_W - from_W;
  const double length_m = way.norm();
  if (length_m == 0.0) return;
  const dGeomID ray = dCreateRay(nullptr, length_m);
  dGeomRaySet(ray, from_W.x(), from_W.y(), from_W.z(), way.x() / length_m, way.y() / length_m,
              way.z() / length_m);
  dGeomRaySetLength(ray, length_m);
  search.nearest = true;
  visit_all(engine, ray, search);
  dGeomDestroy(ray);
}

void visit_box(OdeWorld::Engine& engine, const Probe& probe, ProbeSearch& search) {
  const dGeomID box = dCreateBox(nullptr, probe.size_m.x(), probe.size_m.y(), probe.size_m.z());
  dMatrix3 R;
  copy_rotation(probe.R_WS, R);
  dGeomSetPosition(box, probe.p_WS.x(), probe.p_WS.y(), probe.p_WS.z());
  dGeomSetRotation(box, R);
  visit_all(engine, box, search);
  dGeomDestroy(box);
}

}  // namespace

std::optional<Overlap> OdeWorld::find_obstacle(const Probe& probe, const BodyMask& ignored,
                                               double tolerance_m) const {
  ProbeSearch search{ignored};
  visit_box(*engine_, probe, search);
  if (search.found == nullptr || search.best <= tolerance_m) return std::nullopt;
  return Overlap{name_of(*engine_, *search.found), {}, search.best};
}

bool OdeWorld::overlaps(const Probe& probe, BodyId id) const {
  BodyMask others(engine_->layout.bodies.size(), true);
  others[id.index()] = false;
  ProbeSearch search{others};
  search.floor_counts = false;
  visit_box(*engine_, probe, search);
  return search.found != nullptr;
}

std::optional<RayHit> OdeWorld::cast_ray(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W,
                                         const BodyMask& ignored) const {
  ProbeSearch search{ignored};
  visit_ray(*engine_, from_W, to_W, search);
  if (search.found == nullptr) return std::nullopt;
  return RayHit{name_of(*engine_, *search.found), search.best};
}

std::optional<double> OdeWorld::ray_meets(const Eigen::Vector3d& from_W,
                                          const Eigen::Vector3d& to_W, BodyId id) const {
  BodyMask others(engine_->layout.bodies.size(), true);
  others[id.index()] = false;
  ProbeSearch search{others};
  search.floor_counts = false;
  visit_ray(*engine_, from_W, to_W, search);
  if (search.found == nullptr) return std::nullopt;
  return search.best;
}

}  // namespace parallax::harness
