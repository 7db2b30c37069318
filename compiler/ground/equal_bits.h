#pragma once

#include "compiler/ground/ground_model.h"

namespace parallax::compiler {

/// Finds HoldsAt and ReleasedAt atoms that always have the same value, or always opposite ones ("a
/// thing's place is released exactly while it is carried"), and adds that to the model for every
/// timepoint. Two of them are equal if their values at 0 are, and if the same events under the same
/// conditions make them true and make them false. The conditions are compared as formulas, without
/// a solver, so atoms that are equal for deeper reasons are not found. The traces stay the same.
/// Linear in the effect rows.
void add_equal_bits(GroundModel& model, const EffectRows& rows);

}  // namespace parallax::compiler
