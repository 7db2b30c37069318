#pragma once

#include <string>
#include <vector>

#include "harness/simulator/simulator.h"
#include "harness/world/world_layout.h"

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

/// Where everything is at reset, or why that cannot be.
struct StartState {
  SimStatus status = SimStatus::kOk;  // or kUnsupported, kInvalidStart
  std::string reason;
  std::vector<Placement> placements;  // by BodyId
};

/// The default placements, changed by the settable variables in `given`: robot.x (.y, .yaw) moves
/// all that hangs on the base; NAME.bottom is the height of the lowest point of a free body, and
/// NAME.mass its mass. kUnsupported for a variable that is not settable or not a finite
/// number; kInvalidStart where the base would lie beyond its stops.
StartState read_start_state(const WorldSpec& spec, const WorldLayout& layout, const State& given);

}  // namespace parallax::harness
