#pragma once

#include <set>
#include <string>
#include <vector>

#include "harness/draw/scene.h"
#include "harness/region/region.h"

namespace parallax::harness {

/// A world as it stands, with what led to it.
struct Picture {
  Scene scene;
  SceneAction action;
};

/// The box around all that the pictures show and the floor, with a margin; not empty. Regions
/// (null: none) and goals widen it at most to three times the size of the bodies.
SceneFrame frame_around(const std::vector<Picture>& pictures, const RegionMap* regions);

/// The box around what took part in the action and the robot, with a margin; not smaller than what
/// a person can place. Empty actions: around the robot and what can be moved.
SceneFrame action_frame(const Picture& picture, const RegionMap& regions);

/// The frame around both.
SceneFrame frame_of_both(const SceneFrame& a, const SceneFrame& b);

/// The bodies that take part: the robot's, those that moved, were met, looked for, or differ.
std::set<std::string> taking_part(const Picture& picture);

/// The side from which the action is seen best.
ViewKind side_of(const Picture& picture);

}  // namespace parallax::harness
