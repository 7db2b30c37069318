// Contacts, overlaps and rays in a world that MuJoCo steps.
//
// Two boxes are collided by a function of our own (box_contacts.cc) in the place of the
// engine's. With a hull the engine finds the direction and the depth, and where a face lies on
// the other shape the contacts are put at corners of the common part (hull_contacts.cc). The
// engine's hooks carry no context, so the thread that asks names the world. Contacts get the
// friction of our rules; pairs that never collide are dropped.
//
// A probe is a geom that collides with nothing by itself: it is put where it is asked for,
// spheres round the geoms exclude most of them, and the collision function gives the depth for
// the rest. Rays against hulls are ours (shape_rays.cc).
//
// Cost: a probe or a ray is linear in the geoms, a ray in the faces of the hulls that it comes
// near.

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "compiler/base/contract.h"
#include "harness/engine/hull_contacts.h"
#include "harness/engine/mujoco_engine.h"
#include "harness/engine/mujoco_errors.h"
#include "harness/engine/shape_rays.h"

namespace parallax::harness {
namespace {

using Engine = MujocoWorld::Engine;

const ContactSide& side_of(const Engine& engine, int geom) {
  return *engine.sides[static_cast<std::size_t>(geom)];
}

Eigen::Vector3d place_of(const mjData& data, int geom) {
  return Eigen::Map<const Eigen::Vector3d>(data.geom_xpos + 3 * geom);
}

bool is_floor(const mjModel& model, int geom) { return model.geom_type[geom] == mjGEOM_PLANE; }

/// Can the sphere round the probe meet that round the geom?
bool is_near(const mjModel& model, const mjData& data, int geom, const Eigen::Vector3d& p_W,
             double radius_m) {
  if (is_floor(model, geom)) return p_W.z() <= radius_m;
  const double reach_m = radius_m + model.geom_rbound[geom];
  return (place_of(data, geom) - p_W).squaredNorm() <= reach_m * reach_m;
}

using RowMatrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// The pose of a hull whose mesh a geom is.
struct PlacedMesh {
  Eigen::Vector3d p_WH;
  Eigen::Matrix3d R_WH;
};

PlacedMesh place_of(const mjData& data, int geom, const MeshHull& mesh) {
  const Eigen::Matrix3d R_WH =
      Eigen::Map<const RowMatrix>(data.geom_xmat + 9 * geom) * mesh.R_HG.transpose();
  return {place_of(data, geom) - R_WH * mesh.p_HG, R_WH};
}

const MeshHull& mesh_of(const Engine& engine, const ConvexHull* hull) {
  const auto found = std::find_if(engine.hulls.begin(), engine.hulls.end(),
                                  [&](const MeshHull& mesh) { return mesh.hull.get() == hull; });
  PARALLAX_REQUIRE(found != engine.hulls.end(), "a hull of this world");
  return *found;
}

/// The probe's shape, put where it is asked for. It collides with nothing by itself.
int put_probe(Engine& engine, const Probe& probe) {
  mjModel& model = *engine.model;
  mjData& data = *engine.data;
  Eigen::Vector3d p_WG = probe.p_WS;
  Eigen::Matrix3d R_WG = probe.R_WS;
  int geom = -1;
  if (probe.form == ShapeForm::kHull) {
    const MeshHull& mesh = mesh_of(engine, probe.hull.get());
    geom = mesh.probe;
    p_WG += R_WG * mesh.p_HG;
    R_WG *= mesh.R_HG;
  } else {
    geom = engine.probes[static_cast<std::size_t>(probe.form)];
    Eigen::Map<Eigen::Vector3d>(model.geom_size + 3 * geom) =
        engine_size_m(probe.form, probe.size_m);
    model.geom_rbound[geom] = 0.5 * probe.size_m.norm();
  }
  Eigen::Map<Eigen::Vector3d>(data.geom_xpos + 3 * geom) = p_WG;
  Eigen::Map<RowMatrix>(data.geom_xmat + 9 * geom) = R_WG;
  return geom;
}

// The engine's hooks carry no context, so the thread that asks names the world.
thread_local const Engine* t_engine = nullptr;

class AskedWorld {
 public:
  explicit AskedWorld(const Engine& engine) : previous_(t_engine) { t_engine = &engine; }
  ~AskedWorld() { t_engine = previous_; }
  AskedWorld(const AskedWorld&) = delete;
  AskedWorld& operator=(const AskedWorld&) = delete;

 private:
  const Engine* previous_;
};

/// How deep two geoms overlap; none where they do not touch.
std::optional<double> depth_of(const Engine& engine, int a, int b) {
  const mjModel& model = *engine.model;
  if (model.geom_type[a] > model.geom_type[b]) std::swap(a, b);
  const mjfCollision collide = mjCOLLISIONFUNC[model.geom_type[a]][model.geom_type[b]];
  if (collide == nullptr) return std::nullopt;
  std::array<mjContact, mjMAXCONPAIR> contacts;
  const AskedWorld asked(engine);
  int count = 0;
  ask_engine([&] { count = collide(&model, engine.data.get(), contacts.data(), a, b, 0.0); });
  std::optional<double> deepest;
  for (int i = 0; i < count; ++i) {
    const double depth = -contacts[static_cast<std::size_t>(i)].dist;
    if (depth >= 0.0 && (!deepest || depth > *deepest)) deepest = depth;
  }
  return deepest;
}

/// Along a ray of unit direction; none where the geom is not met.
std::optional<double> ray_meets_geom(const Engine& engine, int geom, const Eigen::Vector3d& from,
                                     const Eigen::Vector3d& direction) {
  const mjModel& model = *engine.model;
  const mjData& data = *engine.data;
  if (is_floor(model, geom)) {
    if (direction.z() == 0.0) return std::nullopt;
    const double way_m = -from.z() / direction.z();
    return way_m >= 0.0 ? std::optional(way_m) : std::nullopt;
  }
  const Eigen::Vector3d d = place_of(data, geom) - from;
  const double radius_m = model.geom_rbound[geom];
  if (d.squaredNorm() - std::pow(d.dot(direction), 2) > radius_m * radius_m) return std::nullopt;
  if (const MeshHull* mesh = engine.hull_of[static_cast<std::size_t>(geom)]) {
    const PlacedMesh at = place_of(data, geom, *mesh);
    return ray_meets_shape(ShapeForm::kHull, mesh->hull->size_m, mesh->hull.get(),
                           at.R_WH.transpose() * (from - at.p_WH), at.R_WH.transpose() * direction);
  }
  const double way_m =
      mju_rayGeom(data.geom_xpos + 3 * geom, data.geom_xmat + 9 * geom, model.geom_size + 3 * geom,
                  from.data(), direction.data(), model.geom_type[geom]);
  return way_m >= 0.0 ? std::optional(way_m) : std::nullopt;
}

PlacedBox box_of(const mjModel& model, const mjData& data, int geom) {
  return {
      place_of(data, geom), Eigen::Map<const Eigen::Vector3d>(model.geom_size + 3 * geom),
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data.geom_xmat + 9 * geom)};
}

int put_out(const BoxContacts& found, mjContact* out) {
  for (int i = 0; i < found.count; ++i) {
    const BoxContact& point = found.points[static_cast<std::size_t>(i)];
    out[i].dist = -point.depth_m;
    std::copy_n(point.p_W.data(), 3, out[i].pos);
    std::copy_n(found.normal_W.data(), 3, out[i].frame);
    std::fill_n(out[i].frame + 3, 6, 0.0);
  }
  return found.count;
}

/// In the place of the engine's own function. No geom has a margin.
int collide_boxes(const mjModel* model, const mjData* data, mjContact* out, int a, int b,
                  mjtNum /*margin*/) {
  return put_out(contacts_of(box_of(*model, *data, a), box_of(*model, *data, b)), out);
}

Polyhedron polyhedron_of(const Engine& engine, const mjModel& model, const mjData& data, int geom) {
  const MeshHull* mesh = engine.hull_of[static_cast<std::size_t>(geom)];
  if (mesh == nullptr) return placed_box(box_of(model, data, geom));
  const PlacedMesh place = place_of(data, geom, *mesh);
  return placed_hull(*mesh->hull, place.p_WH, place.R_WH);
}

mjfCollision by_the_engine = nullptr;  // what it has for all that is convex

/// Finds the contacts of a hull and a box, or of two hulls: where a face lies on the other one, at
/// corners of their common part.
int collide_hulls(const mjModel* model, const mjData* data, mjContact* out, int a, int b,
                  mjtNum margin) {
  // First, so that nothing is held here where the engine fails (ask_engine).
  const int count = by_the_engine(model, data, out, a, b, margin);
  if (count == 0 || t_engine == nullptr) return count;
  const mjContact* const deepest = std::min_element(
      out, out + count, [](const mjContact& x, const mjContact& y) { return x.dist < y.dist; });
  const Eigen::Vector3d normal = Eigen::Map<const Eigen::Vector3d>(deepest->frame);
  const BoxContacts found =
      hull_contacts(polyhedron_of(*t_engine, *model, *data, a),
                    polyhedron_of(*t_engine, *model, *data, b), normal, -deepest->dist);
  return found.count > 0 ? put_out(found, out) : count;
}

}  // namespace

void replace_collisions() {
  by_the_engine = mjCOLLISIONFUNC[mjGEOM_MESH][mjGEOM_MESH];
  mjCOLLISIONFUNC[mjGEOM_BOX][mjGEOM_BOX] = &collide_boxes;
  mjCOLLISIONFUNC[mjGEOM_BOX][mjGEOM_MESH] = &collide_hulls;
  mjCOLLISIONFUNC[mjGEOM_MESH][mjGEOM_MESH] = &collide_hulls;
}

void find_contacts(Engine& engine) {
  constexpr double kLeastFriction = 1e-5;  // of the engine
  mjData& data = *engine.data;
  const AskedWorld asked(engine);
  ask_engine([&] { mj_collision(engine.model.get(), &data); });
  const double erp = engine.solver.contact_erp.value_or(engine.solver.erp);
  int kept = 0;
  for (int i = 0; i < data.ncon; ++i) {
    mjContact& contact = data.contact[i];
    const ContactSide& a = side_of(engine, contact.geom1);
    const ContactSide& b = side_of(engine, contact.geom2);
    if (ContactRules::never_collide(a, b)) continue;
    const double friction = engine.rules.friction(a, b);
    contact.dim = friction > 0.0 ? 3 : 1;
    std::fill_n(contact.friction, 5, std::max(friction, kLeastFriction));
    contact.solref[0] = engine.solver.timestep_s / erp;
    contact.solref[1] = 1.0;
    if (kept != i) data.contact[kept] = contact;
    ++kept;
  }
  data.ncon = kept;
}

void note_touches(Engine& engine) {
  std::fill(engine.touches.begin(), engine.touches.end(), Touch{});
  for (int i = 0; i < engine.data->ncon; ++i) {
    const mjContact& contact = engine.data->contact[i];
    ContactRules::note(side_of(engine, contact.geom1), side_of(engine, contact.geom2),
                       engine.touches);
  }
}

std::optional<Overlap> deepest_contact(const Engine& engine) {
  const mjContact* deepest = nullptr;
  for (int i = 0; i < engine.data->ncon; ++i) {
    const mjContact& contact = engine.data->contact[i];
    if (deepest == nullptr || contact.dist < deepest->dist) deepest = &contact;
  }
  if (deepest == nullptr) return std::nullopt;
  return overlap_of(engine.layout, side_of(engine, deepest->geom1), side_of(engine, deepest->geom2),
                    -deepest->dist);
}

std::optional<Met> MujocoWorld::deepest_met(const Probe& probe, const Sought& sought) const {
  Engine& engine = *engine_;
  const mjModel& model = *engine.model;
  const int own = put_probe(engine, probe);
  const double radius_m = model.geom_rbound[own];
  const Eigen::Vector3d p_W = place_of(*engine.data, own);
  std::optional<Met> met;
  for (int geom = 0; geom < model.ngeom; ++geom) {
    const ContactSide* side = engine.sides[static_cast<std::size_t>(geom)];
    if (side == nullptr || !sought.includes(*side)) continue;
    if (!is_near(model, *engine.data, geom, p_W, radius_m)) continue;
    const auto depth = depth_of(engine, own, geom);
    if (depth && (!met || *depth > met->metres)) met = Met{side, *depth};
  }
  return met;
}

std::optional<Met> MujocoWorld::first_met(const Eigen::Vector3d& from_W,
                                          const Eigen::Vector3d& to_W, const Sought& sought) const {
  const Engine& engine = *engine_;
  const double length_m = (to_W - from_W).norm();
  if (length_m == 0.0) return std::nullopt;
  const Eigen::Vector3d direction = (to_W - from_W) / length_m;
  std::optional<Met> met;
  for (int geom = 0; geom < engine.model->ngeom; ++geom) {
    const ContactSide* side = engine.sides[static_cast<std::size_t>(geom)];
    if (side == nullptr || !sought.includes(*side)) continue;
    const auto way_m = ray_meets_geom(engine, geom, from_W, direction);
    if (!way_m || *way_m > length_m || (met && *way_m >= met->metres)) continue;
    met = Met{side, *way_m};
  }
  return met;
}

}  // namespace parallax::harness
