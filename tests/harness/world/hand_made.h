#pragma once

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/world/world_layout.h"

namespace parallax::harness {

/// A body of one box; fixed in the world unless it has a mass.
inline BodySpec box_body(std::string name, const Eigen::Vector3d& size_m,
                         const Eigen::Vector3d& p_WB, double mass_kg = 0.0) {
  BodySpec body;
  body.name = std::move(name);
  body.shapes = {BodyShape{size_m}};
  body.p_WB = p_WB;
  body.mass_kg = mass_kg;
  return body;
}

inline WorldSpec world_of(std::vector<BodySpec> bodies) {
  WorldSpec spec;
  spec.bodies = std::move(bodies);
  return spec;
}

inline BodySpec& body_of(WorldSpec& spec, std::string_view name) {
  return *std::find_if(spec.bodies.begin(), spec.bodies.end(),
                       [&](const BodySpec& body) { return body.name == name; });
}

inline JointSpec& joint_of(WorldSpec& spec, std::string_view name) {
  return *std::find_if(spec.joints.begin(), spec.joints.end(),
                       [&](const JointSpec& joint) { return joint.name == name; });
}

inline BodyMask mask_of(const WorldLayout& layout, std::initializer_list<std::string_view> names) {
  BodyMask mask(layout.bodies.size(), false);
  for (const std::string_view name : names) mask[layout.find_body(name)->index()] = true;
  return mask;
}

/// The default places of the bodies, by BodyId.
inline std::vector<Placement> default_placements(const WorldLayout& layout) {
  std::vector<Placement> placements;
  for (const BodySpec& body : layout.bodies) {
    placements.push_back({body.p_WB, body.yaw_rad, 0.0});
  }
  return placements;
}

}  // namespace parallax::harness
