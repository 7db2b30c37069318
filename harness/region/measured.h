#pragma once

#include <string>

#include "harness/region/state_mapping.h"

namespace parallax::harness {

/// The values that decide a fluent in a state, beside their bounds:
/// "robot.x = 0.313 m, 87 mm below [0.4, 0.8]", or, of a fluent that holds, "robot.x = 0.413 m
/// within [0.4, 0.8]" on the axis that is nearest to its border. Metres and radians.
/// Empty: the fluent is not compared, or the state lacks its variables.
std::string measured_text(const StateMapping& mapping, const GroundFluent& fluent,
                          const State& state);

}  // namespace parallax::harness
