#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "harness/engine/ode_world.h"
#include "tests/harness/config/scenario_text.h"
#include "tests/harness/world/hand_made.h"

namespace parallax::harness::test {

inline const std::filesystem::path kShipped =
    std::filesystem::path(PARALLAX_SOURCE_DIR) / "scenarios";

/// A scenario with this under `world`.
inline std::string scenario_with(const std::string& world) {
  return "model: domain.e\nhorizon: 2\nworld:\n" + world + R"(
regions: {gaps: allowed, cells: {here: {x: [0, 1]}}}
mapping: {At(region): {inside: region, body: cup, drawn: false}}
actions: {}
)";
}

inline const std::string kCup = R"(  bodies:
    cup: {size_m: [0.1, 0.1, 0.1], mass_kg: 0.2, position_m: [5, 5, 0.05]}
)";

inline const BodySpec& body(const WorldSpec& world, const std::string& name) {
  const auto found = std::find_if(world.bodies.begin(), world.bodies.end(),
                                  [&](const BodySpec& one) { return one.name == name; });
  REQUIRE_MESSAGE(found != world.bodies.end(), name);
  return *found;
}

inline const JointSpec& joint(const WorldSpec& world, const std::string& name) {
  const auto found = std::find_if(world.joints.begin(), world.joints.end(),
                                  [&](const JointSpec& one) { return one.name == name; });
  REQUIRE_MESSAGE(found != world.joints.end(), name);
  return *found;
}

inline std::vector<Eigen::Vector3d> places_after(PhysicsWorld& world, double time_s) {
  const auto steps = std::lround(time_s / world.timestep_s());
  for (long i = 0; i < steps; ++i) REQUIRE(world.step());
  std::vector<Eigen::Vector3d> out;
  for (std::size_t i = 0; i < world.layout().bodies.size(); ++i) {
    out.push_back(world.position(world.layout().bodies.id_at(i)));
  }
  return out;
}

/// Nothing moves by more than this in ten seconds [m], and after the first of them, in which all
/// sinks into the engine's surface layer of a millimetre, by no more than a fifth of one.
inline void check_still(PhysicsWorld& world, double most_m) {
  REQUIRE_FALSE(world.reset(default_placements(world.layout()), 1).has_value());
  const auto before = places_after(world, 0.0), settled = places_after(world, 1.0),
             after = places_after(world, 9.0);
  for (std::size_t i = 0; i < before.size(); ++i) {
    CAPTURE(world.layout().bodies[world.layout().bodies.id_at(i)].name);
    CHECK((after[i] - before[i]).norm() < most_m);
    CHECK((after[i] - settled[i]).norm() < 0.0002);
  }
}

inline void check_still(const WorldSpec& spec, double most_m) {
  OdeWorld world(spec);
  check_still(world, most_m);
}

inline std::string file_in_scenarios(const Workspace& workspace, const std::string& name) {
  std::filesystem::copy(kShipped / name,
                        workspace.folder() / std::filesystem::path(name).filename(),
                        std::filesystem::copy_options::recursive);
  return std::filesystem::path(name).filename().string();
}

}  // namespace parallax::harness::test
