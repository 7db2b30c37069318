#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "harness/world/ode_engine.h"

namespace parallax::harness {
namespace {

constexpr int kMostContacts = 16;

const GeomInfo& info_of(dGeomID geom) { return *static_cast<const GeomInfo*>(dGeomGetData(geom)); }

bool moves(dBodyID body) { return body != nullptr && dBodyIsEnabled(body) != 0; }

void note_touch(const GeomInfo& self, ContactRole other, std::vector<Touch>& touches) {
  if (self.role != ContactRole::kFree) return;
  Touch& touch = touches[self.body->index()];
  switch (other) {
    case ContactRole::kWorld:
    case ContactRole::kFree:
      touch.support = true;
      break;
    case ContactRole::kNearPad:
      touch.near_pad = true;
      break;
    case ContactRole::kFarPad:
      touch.far_pad = true;
      break;
    case ContactRole::kOtherPart:
      break;
  }
}

/// Contact points of a pair, none when both hang together.
int contact_points(dGeomID a, dGeomID b, std::int64_t limit,
                   std::array<dContact, kMostContacts>& out) {
  const std::uint32_t assembly = info_of(a).assembly;
  if (assembly != 0 && assembly == info_of(b).assembly) return 0;
  return dCollide(a, b, static_cast<int>(std::min<std::int64_t>(limit, kMostContacts)),
                  &out[0].geom, sizeof(dContact));
}

void add_contacts(void* data, dGeomID a, dGeomID b) {
  auto& engine = *static_cast<OdeWorld::Engine*>(data);
  const dBodyID body_a = dGeomGetBody(a), body_b = dGeomGetBody(b);
  if (!moves(body_a) && !moves(body_b)) return;
  std::array<dContact, kMostContacts> contacts;
  const int count = contact_points(a, b, engine.solver.max_contacts_per_pair, contacts);
  if (count == 0) return;

  const GeomInfo& info_a = info_of(a);
  const GeomInfo& info_b = info_of(b);
  const double mu = engine.friction[info_a.material * engine.material_count + info_b.material];
  for (int i = 0; i < count; ++i) {
    dSurfaceParameters& surface = contacts[static_cast<std::size_t>(i)].surface;
    surface = dSurfaceParameters{};
    surface.mode = dContactApprox1;
    surface.mu = mu;
    dJointAttach(dJointCreateContact(engine.world, engine.contact_group,
                                     &contacts[static_cast<std::size_t>(i)]),
                 body_a, body_b);
  }
  engine.statistics.contacts += count;
  note_touch(info_a, info_b.role, engine.touches);
  note_touch(info_b, info_a.role, engine.touches);
}

struct OverlapSearch {
  OdeWorld::Engine& engine;
  double depth_m = 0.0;
  const GeomInfo* first = nullptr;
  const GeomInfo* second = nullptr;
};

void search_overlap(void* data, dGeomID a, dGeomID b) {
  auto& search = *static_cast<OverlapSearch*>(data);
  std::array<dContact, kMostContacts> contacts;
  const int count = contact_points(a, b, search.engine.solver.max_contacts_per_pair, contacts);
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

}  // namespace

void make_contacts(OdeWorld::Engine& engine) {
  std::fill(engine.touches.begin(), engine.touches.end(), Touch{});
  visit_pairs(engine, &engine, &add_contacts);
}

std::optional<Overlap> find_deepest_overlap(OdeWorld::Engine& engine) {
  OverlapSearch search{engine};
  visit_pairs(engine, &search, &search_overlap);
  if (search.first == nullptr) return std::nullopt;
  const auto name_of = [&](const GeomInfo& info) -> std::string {
    return info.body ? engine.layout.bodies[*info.body].name : "floor";
  };
  Overlap overlap{name_of(*search.first), name_of(*search.second), search.depth_m};
  if (overlap.second < overlap.first) std::swap(overlap.first, overlap.second);
  return overlap;
}

}  // namespace parallax::harness
