#pragma once

#include <set>
#include <span>
#include <string>
#include <vector>

#include "harness/confidence/tally.h"
#include "harness/region/state_mapping.h"

namespace parallax::harness {

/// The continuous parameters of one trace: the start cuboid's dimensions on one side, and on the
/// other the variables that the expected final state (`final_true` among `fluents`) pins to a
/// region. Booleans never enter a regression; the fluents that rest on them, or that say where a
/// body is not, end in `not_covered`.
RegressionFrame regression_frame(const StateMapping& mapping, const StartCuboid& start,
                                 const std::vector<GroundFluent>& fluents,
                                 const std::set<std::string>& final_true);

/// The values of `names` in `state`; NaN where the state has no number. Angles are unwrapped to
/// within half a turn of the midpoint of their interval in `around` (same length, or empty).
std::vector<double> row_of(const State& state, std::span<const std::string> names,
                           std::span<const Interval> around);

/// One clean run: the start that was drawn and the last observation.
void add_clean_run(Tally& tally, const State& initial, const State& last);

}  // namespace parallax::harness
