#pragma once

#include <string>
#include <vector>

#include "harness/simulator/simulator.h"
#include "harness/world/world_layout.h"

namespace parallax::harness {

/// Where everything is at reset, or why that cannot be.
struct StartState {
  SimStatus status = SimStatus::kOk;  // or kUnsupported, kInvalidStart
  std::string reason;
  std::vector<Placement> placements;  // by BodyId
};

/// Height of the lowest point of an upright body above its origin [m].
double lowest_point_m(const BodySpec& body);

/// The default placements, changed by the settable variables in `given`: robot.x (.y, .yaw) moves
/// all that hangs on the base; NAME.bottom is the height of the lowest point of a free body, and
/// NAME.mass its mass. kUnsupported for a variable that is not settable or not a finite
/// number; kInvalidStart where the base would lie beyond its stops.
StartState read_start_state(const WorldSpec& spec, const WorldLayout& layout, const State& given);

}  // namespace parallax::harness
