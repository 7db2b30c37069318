#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/recording/pose.h"

namespace parallax::harness {

/// Cylinders and capsules stand along the z axis of their pose.
enum class ShapeKind : std::uint8_t { kBox, kSphere, kCylinder, kCapsule, kHull };

struct RecordedShape {
  ShapeKind kind = ShapeKind::kBox;
  /// Box: its sides. Sphere: the radius. Cylinder and capsule: radius and length, the caps of a
  /// capsule not counted. What is left is 0 [m].
  std::array<double, 3> size = {0.0, 0.0, 0.0};
  Pose pose;  // in the body
  /// For a hull: its corners, in the frame of the pose, and the corner numbers of each face.
  std::vector<std::array<double, 3>> corners = {};
  std::vector<std::array<std::uint32_t, 3>> faces = {};
  friend bool operator==(const RecordedShape&, const RecordedShape&) = default;
};

/// The kind of a body, for its colour: part of the building, moved by a joint of the building, part
/// of the robot, a pad of a gripper, something that can be carried, or a camera, which has no shape
/// and looks along the x axis of its pose.
enum class BodyKind : std::uint8_t { kFurniture, kDrawer, kRobot, kGripper, kItem, kCamera };

struct RecordedBody {
  std::string name;
  BodyKind kind = BodyKind::kFurniture;
  std::string colour;  // "#rrggbb"; empty: by the kind
  std::vector<RecordedShape> shapes;
  bool moves = false;  // then frames say where it is, unless it hangs on another
  /// Number of the moving body on which this one hangs without moving against it.
  std::optional<std::size_t> on;
  Pose pose;  // of a static body in the world; of one that hangs on another, in that
  friend bool operator==(const RecordedBody&, const RecordedBody&) = default;
};

/// A line from a shoulder to a hand where the simulator has no bodies between them.
struct RecordedArm {
  std::string name;
  std::size_t from = 0, to = 0;                      // numbers of bodies
  std::array<double, 3> shoulder = {0.0, 0.0, 0.0};  // in the body `from` [m]
  double min_reach_m = 0.0, max_reach_m = 0.0;       // of the tool from the shoulder; 0: unknown
  friend bool operator==(const RecordedArm&, const RecordedArm&) = default;
};

struct RecordedCone {
  double half_angle_rad = 0.0, min_range_m = 0.0, max_range_m = 0.0;
  friend bool operator==(const RecordedCone&, const RecordedCone&) = default;
};

/// The data that stays the same during a simulation.
struct RecordedScene {
  std::vector<RecordedBody> bodies;
  std::vector<std::string> grippers;
  std::vector<RecordedArm> arms;
  std::optional<RecordedCone> camera;  // of bodies of kind kCamera

  /// Numbers of the bodies that have a place in frames, ascending.
  std::vector<std::size_t> moving() const {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (bodies[i].moves && !bodies[i].on) out.push_back(i);
    }
    return out;
  }
  friend bool operator==(const RecordedScene&, const RecordedScene&) = default;
};

}  // namespace parallax::harness
