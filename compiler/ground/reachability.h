#pragma once

#include <vector>

#include "compiler/formula/evaluate.h"
#include "compiler/ground/effect_rows.h"
#include "compiler/ground/possible_atoms.h"

namespace parallax::compiler {

/// What the constraints so far state outright of HoldsAt(fluent, 0), by fluent.
std::vector<Truth> initial_values(const GroundModel& model);

/// Fluents that are always false are left out of large models only, with more HoldsAt atoms than
/// `keep`: in a small one they cost nothing, and an unsatisfiable core can then name every axiom
/// that takes part.
bool is_worth_leaving_out(const GroundModel& model, std::size_t keep);

/// Leaves out fluents that are false at first and that no row can ever make true, and the rows that
/// need them: a fixpoint over the rows, linear in their number for every round.
void drop_unreachable(GroundModel& model, PossibleAtoms& possible, EffectRows& rows,
                      std::size_t keep);

}  // namespace parallax::compiler
