#pragma once

#include <vector>

#include "harness/simulator/simulator.h"
#include "harness/world/world_layout.h"
#include "harness/world/world_spec.h"

namespace parallax::harness {

/// The variables that a simulator made from `spec` observes, sorted by name, without building it:
/// NAME.x .y .z .roll .pitch .yaw .held for each free body. With a robot on a line: robot.x,
/// tool.x, tool.z, opening. With a mobile robot: robot.x, .y, .yaw, .lift, .looking_at; ARM.x, .y,
/// .z, .opening, .parked, .open; for each free body BODY.bottom, BODY.mass, BODY.held_by.ARM,
/// BODY.perceived, BODY.seen.known and BODY.seen.x, .y, .z, .bottom (where it is believed to be; 0
/// when unknown); JOINT.q of sliders that are no fingers, and CHILD.x, .y, .z, .yaw of what they
/// carry. Besides these an observation has "digest". `spec` must pass check_structure.
std::vector<Parameter> observables(const WorldSpec& spec);

/// Sliders whose position says something: all but the fingers.
std::vector<SliderId> observed_sliders(const WorldLayout& layout, const MobileRobotSpec& robot);

}  // namespace parallax::harness
