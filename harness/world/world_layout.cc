#include "harness/world/world_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <string_view>

#include "compiler/base/contract.h"
#include "harness/world/arguments.h"
#include "harness/world/shapes.h"

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

/// The words of a text, which blanks part.
std::vector<std::string_view> words_in(std::string_view text) {
  std::vector<std::string_view> out;
  for (std::size_t at = text.find_first_not_of(' '); at < text.size();) {
    const auto end = std::min(text.find(' ', at), text.size());
    out.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(' ', end);
  }
  return out;
}

void number_groups(WorldLayout& layout) {
  std::map<std::string_view, std::uint32_t> numbers;
  for (const BodySpec& body : layout.bodies) {
    for (const auto word : words_in(body.apart)) numbers.emplace(word, 0U);
  }
  std::uint32_t last = 0;
  for (auto& [word, number] : numbers) number = ++last;
  for (const BodySpec& body : layout.bodies) {
    auto& own = layout.apart_of.emplace_back();
    for (const auto word : words_in(body.apart)) own.push_back(numbers.at(word));
    std::sort(own.begin(), own.end());
  }
}

std::vector<Parameter> mobile_parameters(const WorldSpec& spec, const WorldLayout& layout) {
  const MobileRobotSpec& robot = *spec.mobile;
  const BodyId base = *layout.find_body(robot.base_body);
  std::vector<Parameter> all;
  for (const char* item : {"x", "y"}) {
    all.push_back({std::string("robot.") + item, "m", layout.bodies[base].can_set(item)});
  }
  all.push_back({"robot.yaw", "rad", layout.bodies[base].can_set("yaw")});
  all.push_back({"robot.lift", "m", false});
  all.push_back({"robot.looking_at", "1", false});
  for (const ArmSpec& arm : robot.arms) {
    for (const char* item : {".x", ".y", ".z", ".opening"}) all.push_back({arm.name + item, "m"});
    for (const char* item : {".parked", ".open"}) all.push_back({arm.name + item, "1"});
  }
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    if (!layout.is_free[i]) continue;
    const BodySpec& body = layout.bodies[layout.bodies.id_at(i)];
    all.push_back({body.name + ".bottom", "m", body.can_set("bottom")});
    all.push_back({body.name + ".mass", "kg", body.can_set("mass")});
    for (const ArmSpec& arm : robot.arms) all.push_back({body.name + ".held_by." + arm.name, "1"});
    for (const char* item : {".perceived", ".seen.known"}) all.push_back({body.name + item, "1"});
    for (const char* item : {".seen.x", ".seen.y", ".seen.z", ".seen.bottom"}) {
      all.push_back({body.name + item, "m"});
    }
    all.push_back({body.name + ".seen.yaw", "rad"});
  }
  for (const SliderId id : observed_sliders(layout, robot)) {
    for (Parameter& one : joint_parameters(layout.sliders[id])) all.push_back(std::move(one));
  }
  return all;
}

StartState refusal(SimStatus status, std::string reason) { return {status, std::move(reason), {}}; }

/// Height of the lowest point of an upright body above its origin [m].
double lowest_point_m(const BodySpec& body) {
  double lowest_m = 0.0;
  bool first = true;
  for (const BodyShape& shape : body.shapes) {
    const auto [low, high] =
        span(shape.form, shape.size_m, shape.hull.get(), shape_rotation(shape));
    const double low_m = shape.p_BS.z() + low.z();
    if (first || low_m < lowest_m) lowest_m = low_m;
    first = false;
  }
  return lowest_m;
}

void set_item(Placement& placement, const BodySpec& body, std::string_view item, double value) {
  if (item == "x") placement.p_WB.x() = value;
  if (item == "y") placement.p_WB.y() = value;
  if (item == "z") placement.p_WB.z() = value;
  if (item == "yaw") placement.yaw_rad = value;
  if (item == "bottom") placement.p_WB.z() = value - lowest_point_m(body);
  if (item == "mass") placement.mass_kg = value;
}

/// Moves the whole assembly of the base along x. False when the drive does not go there.
bool shift_line_robot(const WorldSpec& spec, const WorldLayout& layout, BodyId base, double x_m,
                      std::vector<Placement>& placements) {
  const double shift_m = x_m - layout.bodies[base].p_WB.x();
  if (const auto drive = layout.find_slider(spec.robot.base_joint)) {
    const JointSpec& joint = layout.sliders[*drive];
    if (joint.low_m && shift_m < *joint.low_m) return false;
    if (joint.high_m && shift_m > *joint.high_m) return false;
  }
  const std::uint32_t assembly = layout.assembly_of[base.index()];
  for (std::size_t i = 0; i < placements.size(); ++i) {
    if (layout.assembly_of[i] == assembly) placements[i].p_WB.x() += shift_m;
  }
  return true;
}

/// Puts the base at `target` and everything that hangs on it where it belongs beside it.
void move_mobile_robot(const WorldLayout& layout, BodyId base, const Placement& target,
                       std::vector<Placement>& placements) {
  const Placement before = placements[base.index()];
  const double turn = target.yaw_rad - before.yaw_rad;
  const double c = std::cos(turn), s = std::sin(turn);
  const std::uint32_t assembly = layout.assembly_of[base.index()];
  for (std::size_t i = 0; i < placements.size(); ++i) {
    if (layout.assembly_of[i] != assembly) continue;
    const Eigen::Vector3d d = placements[i].p_WB - before.p_WB;
    placements[i].p_WB =
        target.p_WB + Eigen::Vector3d(c * d.x() - s * d.y(), s * d.x() + c * d.y(), d.z());
    placements[i].yaw_rad += turn;
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
    if (joint.type == JointType::kHinge) layout.hinges.add(joint);
  }
  number_groups(layout);
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

std::optional<HingeId> WorldLayout::find_hinge(std::string_view name) const {
  return find_by_name(hinges, name);
}

bool WorldLayout::leads(std::string_view joint) const {
  const auto follows = [&](const JointSpec& one) {
    return one.follows && one.follows->leader == joint;
  };
  return std::any_of(sliders.begin(), sliders.end(), follows) ||
         std::any_of(hinges.begin(), hinges.end(), follows);
}

double grip_gain(const WorldLayout& layout, std::string_view finger_joint,
                 std::string_view near_pad) {
  const auto finger = layout.find_slider(finger_joint);
  const auto pad = layout.find_body(near_pad);
  if (!finger || !pad) return 1.0;
  for (const JointSpec& joint : layout.sliders) {
    if (!joint.follows || joint.follows->leader != finger_joint) continue;
    const BodyId child = *layout.find_body(joint.child);
    if (layout.link_of[child.index()] != layout.link_of[pad->index()]) continue;
    const double along = joint.axis_W.normalized().dot(layout.sliders[*finger].axis_W.normalized());
    return 1.0 - joint.follows->ratio * along;
  }
  return 1.0;
}

std::vector<Parameter> joint_parameters(const JointSpec& joint) {
  std::vector<Parameter> all = {{joint.name + ".q", joint.type == JointType::kHinge ? "rad" : "m"}};
  for (const char* item : {".x", ".y", ".z"}) all.push_back({joint.child + item, "m"});
  all.push_back({joint.child + ".yaw", "rad"});
  return all;
}

/// Sliders whose position says something: all but the fingers.
std::vector<SliderId> observed_sliders(const WorldLayout& layout, const MobileRobotSpec& robot) {
  std::vector<SliderId> found;
  for (std::size_t i = 0; i < layout.sliders.size(); ++i) {
    const SliderId id = layout.sliders.id_at(i);
    const std::string& name = layout.sliders[id].name;
    const bool finger = std::any_of(robot.arms.begin(), robot.arms.end(),
                                    [&](const ArmSpec& arm) { return arm.finger_joint == name; });
    if (!finger) found.push_back(id);
  }
  return found;
}

std::vector<Parameter> observables(const WorldSpec& spec) {
  const WorldLayout layout = lay_out(spec);
  std::vector<Parameter> all;
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    if (!layout.is_free[i]) continue;
    const BodySpec& body = layout.bodies[layout.bodies.id_at(i)];
    all.push_back({body.name + ".held", "1", false});
    for (const char* item : {"x", "y", "z"}) {
      all.push_back({body.name + "." + item, "m", body.can_set(item)});
    }
    for (const char* item : {"roll", "pitch", "yaw"}) {
      all.push_back({body.name + "." + item, "rad", body.can_set(item)});
    }
  }
  if (spec.mobile) {
    const auto more = mobile_parameters(spec, layout);
    all.insert(all.end(), more.begin(), more.end());
  } else if (const auto base = layout.find_body(spec.robot.base_body)) {
    all.push_back({"robot.x", "m", layout.bodies[*base].can_set("x")});
    for (const char* name : {"tool.x", "tool.z", "opening"}) all.push_back({name, "m", false});
  }
  for (const JointSpec& joint : layout.hinges) {
    for (Parameter& one : joint_parameters(joint)) all.push_back(std::move(one));
  }
  std::sort(all.begin(), all.end(),
            [](const Parameter& a, const Parameter& b) { return a.name < b.name; });
  return all;
}

StartState read_start_state(const WorldSpec& spec, const WorldLayout& layout, const State& given) {
  StartState start;
  for (const BodySpec& body : layout.bodies) {
    start.placements.push_back({body.p_WB, body.yaw_rad, 0.0});
  }
  const std::optional<BodyId> base = layout.find_body(base_body(spec));
  Placement robot = base ? start.placements[base->index()] : Placement{};
  for (const auto& [name, value] : given) {
    const std::optional<double> number = as_number(value);
    if (!number || !std::isfinite(*number)) {
      return refusal(SimStatus::kUnsupported, fmt::format("`{}` is not a finite number", name));
    }
    const std::size_t dot = name.rfind('.');
    const std::string_view whole = name;
    const std::string_view item = dot == std::string::npos ? "" : whole.substr(dot + 1);
    const std::string_view owner = whole.substr(0, dot == std::string::npos ? 0 : dot);
    if (owner == "robot" && base && layout.bodies[*base].can_set(item)) {
      set_item(robot, layout.bodies[*base], item, *number);
      if (spec.mobile || shift_line_robot(spec, layout, *base, *number, start.placements)) {
        continue;
      }
      return refusal(
          SimStatus::kInvalidStart,
          fmt::format("`robot` cannot stand at x = {}, beyond the end of its drive", *number));
    }
    const std::optional<BodyId> body = layout.find_body(owner);
    if (!body || !layout.is_free[body->index()] || !layout.bodies[*body].can_set(item)) {
      return refusal(SimStatus::kUnsupported, fmt::format("`{}` cannot be set", name));
    }
    if (item == "mass" && *number <= 0.0) {
      return refusal(SimStatus::kInvalidStart, fmt::format("{} = {} is no mass", name, *number));
    }
    set_item(start.placements[body->index()], layout.bodies[*body], item, *number);
  }
  if (spec.mobile && base) move_mobile_robot(layout, *base, robot, start.placements);
  return start;
}

}  // namespace parallax::harness
