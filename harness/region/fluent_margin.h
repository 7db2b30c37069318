#pragma once

#include <optional>

#include "harness/region/state_mapping.h"

namespace parallax::harness {

/// How far a state is from changing what it says of a fluent of which `predicted` is expected:
/// signed distance to the border of the expected cell, in widths of that cell, positive inside of
/// it. Of a body in a region the nearest face counts; of one that has to be upright also how far it
/// leans. None: the fluent is read from flags and words, which have no distance, is not to hold in
/// a region (the fluent of the region that the body is in says it), or is not compared.
std::optional<double> fluent_margin(const StateMapping& mapping, const GroundFluent& fluent,
                                    bool predicted, const State& state);

}  // namespace parallax::harness
