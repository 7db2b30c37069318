#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/engine/ode_world.h"

namespace parallax::harness {

/// Decides the colour. kDrawer: carried by a joint of the furniture.
enum class SceneKind : std::uint8_t { kFurniture, kDrawer, kRobot, kGripper, kItem };

struct SceneBox {
  std::string body;
  SceneKind kind = SceneKind::kFurniture;
  Probe box;
  Eigen::Vector3d origin_W = Eigen::Vector3d::Zero();  // of the body
};

/// From a shoulder to its palm. The simulator has no body there; without the line a hand would
/// hang in the air.
struct SceneArm {
  std::string name;
  Eigen::Vector3d from_W = Eigen::Vector3d::Zero(), to_W = Eigen::Vector3d::Zero();
};

/// A world as it stands, box by box.
struct Scene {
  std::vector<SceneBox> boxes;  // in order of the bodies' names
  std::vector<SceneArm> arms;
  std::string base;  // the robot's body that drives; empty: none
};

Scene scene_of(const OdeWorld& world, const WorldSpec& spec);

}  // namespace parallax::harness
