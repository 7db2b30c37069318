// Contacts of a step, overlaps and rays in a world that ODE steps.
//
// ODE's spaces find the pairs, spaces of bodies first, then the shapes in them. Of the many
// points at which a hull touches, the deepest is kept, then again and again the one farthest
// from those kept (farthest-point sampling, Gonzalez 1985), so that a body stands on all sides
// of its base. The mesh of a hull is a surface; what lies wholly inside touches nothing, so
// without contacts a point of the one shape is looked up among the planes of the other's faces.
// A body that something wakes falls asleep again in the next step if it has not gained the
// threshold's speed in one, and would lie still in a moving drawer for ever; so what moves keeps
// awake what it touches. Contacts become joints later: they may be thinned out (ode_thin.cc),
// and they decide which joints rest.
//
// Cost: for each pair ODE's collision, and for a hull the product of its points and those kept.
// A probe or a ray is compared with the shapes whose boxes it meets.

#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "harness/engine/ode_engine.h"
#include "harness/engine/ode_rest.h"
#include "harness/engine/ode_vector.h"

namespace parallax::harness {
namespace {

constexpr int kMostContacts = 16, kMostHullContacts = 256;

bool moves(dBodyID body) { return body != nullptr && dBodyIsEnabled(body) != 0; }

/// A body at rest on something that begins to move gains less speed in a step than the threshold
/// of sleep, and its time is up: it would fall asleep again in every step. So what moves keeps
/// awake what it touches.
void keep_awake(const SolverSpec& solver, dBodyID mover, dBodyID other) {
  if (mover == nullptr || other == nullptr || dBodyIsEnabled(mover) == 0) return;
  constexpr double kShareOfThreshold = 0.1;
  const dReal* v = dBodyGetLinearVel(mover);
  const double speed_m_s = std::abs(v[0]) + std::abs(v[1]) + std::abs(v[2]);
  if (speed_m_s > kShareOfThreshold * solver.sleep_linear_m_s) dBodyEnable(other);
}

/// Picks the deepest of many points, then repeatedly the one farthest from those taken. A body with
/// many corners below thus stands on all sides of them, not on the first few.
int spread_out(const std::array<dContactGeom, kMostHullContacts>& found, int count, int limit,
               std::array<dContact, kMostContacts>& out) {
  const auto point = [&](int i) {
    const auto& pos = found[static_cast<std::size_t>(i)].pos;
    return Eigen::Vector3d(pos[0], pos[1], pos[2]);
  };
  std::array<double, kMostHullContacts> away;  // from those taken; below 0: taken
  away.fill(std::numeric_limits<double>::infinity());
  int next = 0;
  for (int i = 1; i < count; ++i) {
    if (found[static_cast<std::size_t>(i)].depth > found[static_cast<std::size_t>(next)].depth) {
      next = i;
    }
  }
  int taken = 0;
  while (taken < std::min(count, limit)) {
    out[static_cast<std::size_t>(taken++)].geom = found[static_cast<std::size_t>(next)];
    away[static_cast<std::size_t>(next)] = -1.0;
    int farthest = 0;
    for (int i = 0; i < count; ++i) {
      double& way = away[static_cast<std::size_t>(i)];
      if (way >= 0.0) way = std::min(way, (point(i) - point(next)).squaredNorm());
      if (way > away[static_cast<std::size_t>(farthest)]) farthest = i;
    }
    next = farthest;
  }
  return taken;
}

/// Contact points of a pair, none when they are kept apart.
int contact_points(dGeomID a, dGeomID b, std::int64_t limit,
                   std::array<dContact, kMostContacts>& out) {
  if (ContactRules::never_collide(info_of(a).side, info_of(b).side)) return 0;
  const int most = static_cast<int>(std::min<std::int64_t>(limit, kMostContacts));
  if (info_of(a).hull == nullptr && info_of(b).hull == nullptr) {
    return dCollide(a, b, most, &out[0].geom, sizeof(dContact));
  }
  std::array<dContactGeom, kMostHullContacts> found;
  const int count = dCollide(a, b, kMostHullContacts, found.data(), sizeof(dContactGeom));
  return spread_out(found, count, most, out);
}

void set_stiffness(const SolverSpec& solver, double softening, dSurfaceParameters& surface) {
  if (solver.contact_erp) {
    surface.mode |= dContactSoftERP;
    surface.soft_erp = *solver.contact_erp;
  }
  if (solver.contact_cfm || softening > 1.0) {
    surface.mode |= dContactSoftCFM;
    surface.soft_cfm = softening * solver.contact_cfm.value_or(solver.cfm);
  }
  if (softening > 1.0) {  // of friction
    surface.mode |= dContactSlip1 | dContactSlip2;
    surface.slip1 = surface.slip2 = softening * solver.cfm;
  }
}

/// The body that moves a geom; null: nothing moves it.
dBodyID mover(const OdeWorld::Engine& engine, const GeomInfo& info) {
  return info.link ? engine.resting->host(info.link->index()) : nullptr;
}

/// Two spaces, or a space and a geom: looks closer.
bool look_inside(void* data, dGeomID a, dGeomID b, dNearCallback* callback) {
  if (dGeomIsSpace(a) == 0 && dGeomIsSpace(b) == 0) return false;
  dSpaceCollide2(a, b, data, callback);
  return true;
}

void add_contacts(void* data, dGeomID a, dGeomID b) {
  if (look_inside(data, a, b, &add_contacts)) return;
  auto& engine = *static_cast<OdeWorld::Engine*>(data);
  const GeomInfo& info_a = info_of(a);
  const GeomInfo& info_b = info_of(b);
  const dBodyID body_a = mover(engine, info_a), body_b = mover(engine, info_b);
  if (!moves(body_a) && !moves(body_b)) return;
  std::array<dContact, kMostContacts> contacts;
  const int count = contact_points(a, b, engine.solver.max_contacts_per_pair, contacts);
  if (count == 0) return;

  keep_awake(engine.solver, body_a, body_b);
  keep_awake(engine.solver, body_b, body_a);
  const double mu = engine.rules.friction(info_a.side, info_b.side);
  for (int i = 0; i < count; ++i) {
    const dContactGeom& geom = contacts[static_cast<std::size_t>(i)].geom;
    engine.new_contacts.push_back(
        {a, b, to_vector(geom.pos), to_vector(geom.normal), geom.depth, mu});
  }
  if (info_a.link) engine.touched[info_a.link->index()] = true;
  if (info_b.link) engine.touched[info_b.link->index()] = true;
  ContactRules::note(info_a.side, info_b.side, engine.touches);
}

Eigen::Vector3d in_frame_of(dGeomID geom, const Eigen::Vector3d& p_W) {
  const dReal *p = dGeomGetPosition(geom), *R = dGeomGetRotation(geom);
  const Eigen::Vector3d from = p_W - Eigen::Vector3d(p[0], p[1], p[2]);
  return {R[0] * from.x() + R[4] * from.y() + R[8] * from.z(),
          R[1] * from.x() + R[5] * from.y() + R[9] * from.z(),
          R[2] * from.x() + R[6] * from.y() + R[10] * from.z()};
}

/// A point that the geom is sure to have: its middle, or the corner of a hull.
Eigen::Vector3d point_in(dGeomID geom, const ConvexHull* hull) {
  const dReal *p = dGeomGetPosition(geom), *R = dGeomGetRotation(geom);
  const Eigen::Vector3d v = hull == nullptr ? Eigen::Vector3d::Zero() : hull->vertices.front();
  return {p[0] + R[0] * v.x() + R[1] * v.y() + R[2] * v.z(),
          p[1] + R[4] * v.x() + R[5] * v.y() + R[6] * v.z(),
          p[2] + R[8] * v.x() + R[9] * v.y() + R[10] * v.z()};
}

/// The mesh of a hull is its surface: what is in it as a whole touches nothing. How deep that is;
/// 0 where nothing is in the other. Planes and rays have no middle.
double depth_within(dGeomID a, const ConvexHull* hull_a, dGeomID b, const ConvexHull* hull_b) {
  const auto has_middle = [](dGeomID geom) {
    const int kind = dGeomGetClass(geom);
    return kind != dPlaneClass && kind != dRayClass;
  };
  double depth = 0.0;
  if (hull_a != nullptr && has_middle(b)) {
    depth = std::max(depth, hull_a->depth_of(in_frame_of(a, point_in(b, hull_b))));
  }
  if (hull_b != nullptr && has_middle(a)) {
    depth = std::max(depth, hull_b->depth_of(in_frame_of(b, point_in(a, hull_a))));
  }
  return depth;
}

struct OverlapSearch {
  OdeWorld::Engine& engine;
  double depth_m = 0.0;
  const GeomInfo* first = nullptr;
  const GeomInfo* second = nullptr;
};

void search_overlap(void* data, dGeomID a, dGeomID b) {
  if (look_inside(data, a, b, &search_overlap)) return;
  auto& search = *static_cast<OverlapSearch*>(data);
  std::array<dContact, kMostContacts> contacts;
  if (ContactRules::never_collide(info_of(a).side, info_of(b).side)) return;
  int count = contact_points(a, b, search.engine.solver.max_contacts_per_pair, contacts);
  if (count == 0) {
    const double depth_m = depth_within(a, info_of(a).hull, b, info_of(b).hull);
    if (depth_m > 0.0) contacts[static_cast<std::size_t>(count++)].geom.depth = depth_m;
  }
  for (int i = 0; i < count; ++i) {
    const double depth_m = contacts[static_cast<std::size_t>(i)].geom.depth;
    if (search.first != nullptr && depth_m <= search.depth_m) continue;
    search.depth_m = depth_m;
    search.first = &info_of(a);
    search.second = &info_of(b);
  }
}

void visit_pairs(OdeWorld::Engine& engine, void* data, dNearCallback* callback) {
  dSpaceCollide(engine.movable_space, data, callback);
  dSpaceCollide2(reinterpret_cast<dGeomID>(engine.movable_space),  // spaces are geoms
                 reinterpret_cast<dGeomID>(engine.static_space), data, callback);
}

struct ProbeSearch {
  const Sought& sought;
  bool nearest = false;
  std::optional<Met> met = {};
  const ConvexHull* probe_hull = nullptr;
};

/// One of the two is the probe, which carries no GeomInfo.
void visit(void* data, dGeomID a, dGeomID b) {
  if (look_inside(data, a, b, &visit)) return;
  auto& search = *static_cast<ProbeSearch*>(data);
  const dGeomID other = dGeomGetData(a) == nullptr ? b : a;
  const GeomInfo& info = info_of(other);
  if (!search.sought.includes(info.side)) return;
  std::array<dContactGeom, 8> contacts;
  int count =
      dCollide(a, b, static_cast<int>(contacts.size()), contacts.data(), sizeof(dContactGeom));
  if (count == 0 && !search.nearest) {
    const dGeomID probe = other == a ? b : a;
    const double depth = depth_within(other, info.hull, probe, search.probe_hull);
    if (depth > 0.0) contacts[static_cast<std::size_t>(count++)].depth = depth;
  }
  for (int i = 0; i < count; ++i) {
    const double depth = contacts[static_cast<std::size_t>(i)].depth;
    const bool better =
        !search.met || (search.nearest ? depth < search.met->metres : depth > search.met->metres);
    if (better) search.met = Met{&info.side, depth};
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

void visit_probe(OdeWorld::Engine& engine, const Probe& probe, ProbeSearch& search) {
  const dGeomID geom = create_geom(engine, nullptr, {probe.form, probe.size_m, probe.hull});
  search.probe_hull = probe.hull.get();
  dMatrix3 R;
  copy_rotation(probe.R_WS, R);
  dGeomSetPosition(geom, probe.p_WS.x(), probe.p_WS.y(), probe.p_WS.z());
  dGeomSetRotation(geom, R);
  visit_all(engine, geom, search);
  dGeomDestroy(geom);
}

}  // namespace

const GeomInfo& info_of(dxGeom* geom) { return *static_cast<const GeomInfo*>(dGeomGetData(geom)); }

void find_contacts(OdeWorld::Engine& engine) {
  std::fill(engine.touches.begin(), engine.touches.end(), Touch{});
  std::fill(engine.touched.begin(), engine.touched.end(), false);
  engine.new_contacts.clear();
  visit_pairs(engine, &engine, &add_contacts);
  if (engine.solver.max_contacts_per_side) {
    thin_out(engine.new_contacts, static_cast<std::size_t>(*engine.solver.max_contacts_per_side));
  }
  engine.statistics.contacts += static_cast<std::int64_t>(engine.new_contacts.size());
}

void attach_contacts(OdeWorld::Engine& engine, double softening) {
  dContact contact{};
  dSurfaceParameters& surface = contact.surface;
  surface.mode = dContactApprox1;
  set_stiffness(engine.solver, softening, surface);
  Hosts& hosts = engine.resting->hosts();
  hosts.expect_contacts(engine.new_contacts.size());
  const auto link_of = [](const GeomInfo& info) {
    return info.link ? std::optional(info.link->index()) : std::nullopt;
  };
  for (const NewContact& found : engine.new_contacts) {
    surface.mu = found.friction;
    contact.geom.g1 = found.a;
    contact.geom.g2 = found.b;
    contact.geom.depth = found.depth_m;
    for (int i = 0; i < 3; ++i) {
      contact.geom.pos[i] = found.p_W[i];
      contact.geom.normal[i] = found.normal_W[i];
    }
    const GeomInfo &info_a = info_of(found.a), &info_b = info_of(found.b);
    dxJoint* const joint = dJointCreateContact(engine.world, engine.contact_group, &contact);
    dJointAttach(joint, mover(engine, info_a), mover(engine, info_b));
    hosts.listen(joint, link_of(info_a), link_of(info_b));
  }
}

std::optional<Overlap> find_deepest_overlap(OdeWorld::Engine& engine) {
  OverlapSearch search{engine};
  visit_pairs(engine, &search, &search_overlap);
  if (search.first == nullptr) return std::nullopt;
  return overlap_of(engine.layout, search.first->side, search.second->side, search.depth_m);
}

std::optional<Met> OdeWorld::deepest_met(const Probe& probe, const Sought& sought) const {
  ProbeSearch search{sought};
  visit_probe(*engine_, probe, search);
  return search.met;
}

std::optional<Met> OdeWorld::first_met(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W,
                                       const Sought& sought) const {
  ProbeSearch search{sought};
  visit_ray(*engine_, from_W, to_W, search);
  return search.met;
}

}  // namespace parallax::harness
