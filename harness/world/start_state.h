#pragma once

#include <string>
#include <vector>

#include "harness/world/ode_world.h"
#include "harness/world/simulator.h"

namespace parallax::harness {

/// Where everything is at reset, or why that cannot be.
struct StartState {
  SimStatus status = SimStatus::kOk;  // or kUnsupported, kInvalidStart
  std::string reason;
  std::vector<Placement> placements;  // by BodyId
};

/// The default placements, changed by the settable variables in `given`. Moving the robot's base
/// moves all that hangs on it. kUnsupported for a variable that is not settable or not a finite
/// number; kInvalidStart where the base would lie beyond its stops.
StartState read_start_state(const WorldSpec& spec, const WorldLayout& layout, const State& given);

}  // namespace parallax::harness
