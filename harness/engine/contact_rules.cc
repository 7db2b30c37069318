#include "harness/engine/contact_rules.h"

#include <algorithm>
#include <utility>

namespace parallax::harness {
namespace {

std::vector<std::string> materials_of(const WorldSpec& spec) {
  std::vector<std::string> all{spec.floor_material};
  for (const BodySpec& body : spec.bodies) all.push_back(body.material);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

void note_one(const ContactSide& self, const ContactSide& other, std::vector<Touch>& touches) {
  if (self.role != ShapeRole::kFree) return;
  Touch& touch = touches[self.body->index()];
  switch (other.role) {
    case ShapeRole::kWorld:
    case ShapeRole::kFree:
      touch.support = true;
      break;
    case ShapeRole::kNearPad:
      touch.near_pads |= 1U << other.gripper;
      break;
    case ShapeRole::kFarPad:
      touch.far_pads |= 1U << other.gripper;
      break;
    case ShapeRole::kPart:
      break;
  }
}

/// As a pad, if it is one.
void mark_pad(const std::vector<GripperSpec>& grippers, const std::string& name,
              ContactSide& side) {
  for (std::uint32_t gripper = 0; gripper < grippers.size(); ++gripper) {
    const bool near = name == grippers[gripper].near_pad_body;
    if (!near && name != grippers[gripper].far_pad_body) continue;
    side.role = near ? ShapeRole::kNearPad : ShapeRole::kFarPad;
    side.gripper = gripper;
  }
}

}  // namespace

ContactRules::ContactRules(const WorldSpec& spec, const WorldLayout& layout) {
  const std::vector<std::string> materials = materials_of(spec);
  material_count_ = static_cast<std::uint32_t>(materials.size());
  for (const std::string& a : materials) {
    for (const std::string& b : materials) {
      const auto found = spec.friction.pairs.find(std::minmax(a, b));
      friction_.push_back(found == spec.friction.pairs.end() ? spec.friction.fallback
                                                             : found->second);
    }
  }
  const auto index_of = [&](const std::string& name) {
    return static_cast<std::uint32_t>(std::lower_bound(materials.begin(), materials.end(), name) -
                                      materials.begin());
  };
  floor_.material = index_of(spec.floor_material);

  const std::vector<GripperSpec> all_grippers = grippers(spec);
  for (std::size_t i = 0; i < layout.bodies.size() && !all_grippers.empty(); ++i) {
    const std::string& name = layout.bodies[layout.bodies.id_at(i)].name;
    if (name == all_grippers.front().near_pad_body) robot_assembly_ = layout.assembly_of[i];
  }
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    const BodyId id = layout.bodies.id_at(i);
    const BodySpec& body = layout.bodies[id];
    ContactSide& side = sides_.emplace_back();
    side.body = id;
    side.assembly = layout.assembly_of[i];
    side.apart = layout.apart_of[i];
    side.material = index_of(body.material);
    if (layout.is_free[i]) {
      side.role = ShapeRole::kFree;
    } else if (is_robot(side)) {
      side.role = ShapeRole::kPart;
    }
    mark_pad(all_grippers, body.name, side);
  }
}

void ContactRules::note(const ContactSide& a, const ContactSide& b, std::vector<Touch>& touches) {
  note_one(a, b, touches);
  note_one(b, a, touches);
}

std::string name_of(const WorldLayout& layout, const ContactSide& side) {
  return side.body ? layout.bodies[*side.body].name : "floor";
}

Overlap overlap_of(const WorldLayout& layout, const ContactSide& a, const ContactSide& b,
                   double depth_m) {
  Overlap overlap{name_of(layout, a), name_of(layout, b), depth_m};
  if (overlap.second < overlap.first) std::swap(overlap.first, overlap.second);
  return overlap;
}

}  // namespace parallax::harness
