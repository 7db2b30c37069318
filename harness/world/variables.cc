#include "harness/world/variables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "harness/world/arguments.h"

namespace parallax::harness {
namespace {

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
  }
  for (const SliderId id : observed_sliders(layout, robot)) {
    const JointSpec& joint = layout.sliders[id];
    all.push_back({joint.name + ".q", "m"});
    for (const char* item : {".x", ".y", ".z"}) all.push_back({joint.child + item, "m"});
    all.push_back({joint.child + ".yaw", "rad"});
  }
  return all;
}

StartState refusal(SimStatus status, std::string reason) { return {status, std::move(reason), {}}; }

/// Height of the lowest point of an upright body above its origin [m].
double lowest_point_m(const BodySpec& body) {
  double lowest_m = 0.0;
  bool first = true;
  for (const BoxShape& shape : body.shapes) {
    const double low_m = shape.p_BS.z() - 0.5 * shape.size_m.z();
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
      return refusal(SimStatus::kInvalidStart,
                     fmt::format("robot.x = {} lies beyond the end of the drive", *number));
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
