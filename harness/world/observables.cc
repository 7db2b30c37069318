#include "harness/world/observables.h"

#include <algorithm>

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

}  // namespace parallax::harness
