#include "harness/world/world_layout.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "compiler/base/contract.h"

namespace parallax::harness {
namespace {

constexpr auto kByName = [](const auto& a, const auto& b) { return a.name < b.name; };

/// Disjoint sets of bodies; the representative is the smallest index.
class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t find(std::size_t item) const {
    while (parent_[item] != item) item = parent_[item];
    return item;
  }
  void join(std::size_t a, std::size_t b) {
    const std::size_t one = find(a), other = find(b);
    parent_[std::max(one, other)] = std::min(one, other);
  }

 private:
  std::vector<std::size_t> parent_;
};

template <typename IdType, typename T>
std::optional<IdType> find_by_name(const base::Store<IdType, T>& sorted, std::string_view name) {
  const auto found =
      std::lower_bound(sorted.begin(), sorted.end(), name,
                       [](const T& item, std::string_view n) { return item.name < n; });
  if (found == sorted.end() || found->name != name) return std::nullopt;
  return sorted.id_at(static_cast<std::size_t>(found - sorted.begin()));
}

/// Finds which bodies are welded, to each other or to the world.
struct Welds {
  Groups groups;
  std::vector<bool> is_static;  // by representative

  explicit Welds(const WorldLayout& layout, const std::vector<JointSpec>& joints)
      : groups(layout.bodies.size()), is_static(layout.bodies.size(), false) {
    for (const JointSpec& joint : joints) {
      if (joint.type != JointType::kFixed || joint.parent.empty()) continue;
      groups.join(layout.find_body(joint.parent)->index(), layout.find_body(joint.child)->index());
    }
    for (const JointSpec& joint : joints) {
      if (joint.type != JointType::kFixed || !joint.parent.empty()) continue;
      is_static[groups.find(layout.find_body(joint.child)->index())] = true;
    }
    std::size_t index = 0;
    for (const BodySpec& body : layout.bodies) {
      if (body.mass_kg == 0.0) is_static[groups.find(index)] = true;
      ++index;
    }
  }
};

void add_links(WorldLayout& layout, const Welds& welds) {
  std::map<std::size_t, LinkId> link_by_group;
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    const std::size_t group = welds.groups.find(i);
    if (welds.is_static[group]) {
      layout.link_of.emplace_back(std::nullopt);
      continue;
    }
    auto found = link_by_group.find(group);
    if (found == link_by_group.end()) {
      found = link_by_group.emplace(group, layout.links.add(Link{})).first;
    }
    layout.links[found->second].members.push_back(layout.bodies.id_at(i));
    layout.link_of.emplace_back(found->second);
  }
}

/// Assemblies hang together by joints, but not through a part that is fixed to the world.
void add_assemblies(WorldLayout& layout, const std::vector<JointSpec>& joints) {
  Groups groups(layout.bodies.size());
  for (const JointSpec& joint : joints) {
    if (joint.parent.empty()) continue;
    const std::size_t parent = layout.find_body(joint.parent)->index();
    const std::size_t child = layout.find_body(joint.child)->index();
    if (layout.link_of[parent] && layout.link_of[child]) groups.join(parent, child);
  }
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    layout.assembly_of.push_back(layout.link_of[i] ? static_cast<std::uint32_t>(groups.find(i) + 1)
                                                   : 0U);
  }
}

}  // namespace

std::optional<BodyId> WorldLayout::find_body(std::string_view name) const {
  return find_by_name(bodies, name);
}

std::optional<SliderId> WorldLayout::find_slider(std::string_view name) const {
  return find_by_name(sliders, name);
}

std::optional<GantryId> WorldLayout::find_gantry(std::string_view name) const {
  return find_by_name(gantries, name);
}

WorldLayout lay_out(const WorldSpec& spec) {
  WorldLayout layout;
  std::vector<BodySpec> bodies = spec.bodies;
  std::vector<JointSpec> joints = spec.joints;
  std::sort(bodies.begin(), bodies.end(), kByName);
  std::sort(joints.begin(), joints.end(), kByName);
  for (BodySpec& body : bodies) layout.bodies.add(std::move(body));
  for (const JointSpec& joint : joints) {
    PARALLAX_REQUIRE(layout.find_body(joint.child), "a world that passed check_world");
    if (joint.type == JointType::kSlider) layout.sliders.add(joint);
    if (joint.type == JointType::kGantry) layout.gantries.add(joint);
  }
  add_links(layout, Welds(layout, joints));
  add_assemblies(layout, joints);
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    const std::string& name = layout.bodies[layout.bodies.id_at(i)].name;
    const bool named = std::any_of(joints.begin(), joints.end(), [&](const JointSpec& joint) {
      return joint.parent == name || joint.child == name;
    });
    layout.is_free.push_back(layout.link_of[i].has_value() && !named);
  }
  return layout;
}

}  // namespace parallax::harness
