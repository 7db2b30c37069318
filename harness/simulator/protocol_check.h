#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/simulator/simulator.h"

namespace parallax::harness {

// Checks of answers that can be read (docs/reference/protocol.md). Runs and `adapter-check` share
// them, so that neither lets pass what the other refuses.

/// Faults of a simulator's handshake: no name, an unknown determinism, names that are declared
/// twice, reversed bounds, a negative time step. A run is refused.
std::vector<std::string> info_faults(const SimulatorInfo& info);

/// Oddities of a handshake, which a run only warns of: unknown words in `capabilities`. Units are
/// checked in units.h.
std::vector<std::string> info_oddities(const SimulatorInfo& info);

/// The longest simulated time that an act may say it took: 5 % and two steps beyond its limit.
double most_sim_time_s(double limit_s, const SimulatorInfo& info);

/// The fault of an act's outcome; empty: none. A run with one counts as lost.
std::string outcome_fault(std::string_view action, const Outcome& outcome, double limit_s,
                          const SimulatorInfo& info);

}  // namespace parallax::harness
