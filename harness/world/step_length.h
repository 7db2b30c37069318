#pragma once

#include <string>
#include <vector>

#include "harness/world/arguments.h"
#include "harness/world/world_layout.h"

namespace parallax::harness {

// Engines look for contacts once a step. What goes farther in one step than the thinner of two
// shapes is thick may be on the other side before anything was noticed, or be pushed out there.

/// Least width of a shape [m]; of a hull, between a face and what lies farthest behind it.
double thickness_m(const BodyShape& shape);

/// Does the argument say how fast something moves?
bool is_speed(const ArgumentSpec& argument);

/// Something that goes farther in a step than the thinnest shape that it may meet, or is made of.
struct LongStep {
  std::string argument;  // of the controller; empty: a fall
  std::string body;      // that falls; empty: an argument
  double speed_m_s = 0.0, step_m = 0.0;
  std::string thin_body;
  double thickness_m = 0.0;  // of its thinnest shape
};

/// Speeds [m/s, rad/s] that `given`, or a fallback of the table, asks a controller for. Moved by
/// `going` and `drive` are all parts of the robot, by `move-torso` what the torso carries, by
/// others the hand: on a line what the reach carries, else the palm and what hangs on it. They may
/// meet every body that collides with them, wherever it is, and hold every free one. A turn of the
/// base counts at the part of the robot that is farthest out.
std::vector<LongStep> long_steps(const ControllerSpec& controller, const State& given,
                                 const WorldSpec& world, const WorldLayout& layout);

/// Free bodies that stand above another one by default, with nothing between: they reach it at
/// sqrt(2 g h). The floor has no other side.
std::vector<LongStep> long_falls(const WorldSpec& world, const WorldLayout& layout);

}  // namespace parallax::harness
