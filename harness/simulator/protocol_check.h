#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/simulator/simulator.h"

namespace parallax::harness {

// What the protocol asks of answers that can be read (docs/simulator_protocol.md). Runs and
// `adapter-check` ask here, so that neither lets pass what the other refuses.

/// What is wrong with what a simulator says of itself: no name, a determinism that is none, things
/// that are declared twice, bounds that are reversed, a time step below 0. A run is refused.
std::vector<std::string> info_faults(const SimulatorInfo& info);

/// What is odd about it, so that a run goes on with a warning: words of `capabilities` that are not
/// known. What is odd about units is a matter of its own (units.h).
std::vector<std::string> info_oddities(const SimulatorInfo& info);

/// The longest simulated time that an act may say it took: 5 % and two steps beyond its limit.
double most_sim_time_s(double limit_s, const SimulatorInfo& info);

/// What is wrong with the outcome of an act; empty: nothing. A run counts it as lost.
std::string outcome_fault(std::string_view action, const Outcome& outcome, double limit_s,
                          const SimulatorInfo& info);

}  // namespace parallax::harness
