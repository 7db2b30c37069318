#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
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

/// The way of a base, a hand or an item.
struct SceneTrack {
  std::string name;
  SceneKind kind = SceneKind::kRobot;
  std::vector<Eigen::Vector3d> points_W;
};

/// A stretch of an action's way that was not driven, and the point where it was to end.
struct SceneGoal {
  Eigen::Vector3d from_W = Eigen::Vector3d::Zero(), to_W = Eigen::Vector3d::Zero();
  bool reached = false;
};

/// What a camera looks at: a cone.
struct SceneGaze {
  Eigen::Vector3d camera_W = Eigen::Vector3d::Zero(), point_W = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> border_W;  // of its far end, in order round the gaze
};

/// A body that was looked for.
struct SceneSought {
  std::string body;
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  bool seen = false;
};

/// What one action did, to be drawn over the world as it stands at its end.
struct SceneAction {
  std::vector<SceneTrack> tracks;
  std::optional<SceneGoal> goal;
  std::optional<SceneGaze> gaze;
  std::vector<SceneSought> sought;
  Scene ghost;                     // what stood elsewhere at an earlier moment
  Scene meeting;                   // where something would have met another body
  std::vector<std::string> met;    // bodies that the reason of a failure names
  std::vector<std::string> notes;  // what the marks mean: "dashed: 5.3 s into the action"
};

}  // namespace parallax::harness
