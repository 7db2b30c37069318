#pragma once

#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "compiler/ground/ground_model.h"
#include "compiler/ground/pass.h"

namespace parallax::compiler {

/// Turns the constraints into clauses. Top-level conjunctions are split, small disjunctions are
/// emitted directly, everything deeper gets an auxiliary variable that is defined in the polarity
/// in which it is used (Plaisted and Greenbaum 1986). What holds at every timepoint is encoded once
/// and repeated by moving its variables. Fills everything of the result but `plan` and
/// `has_constraints`. Linear in the formula graph, and in the clauses written. `log` may be null.
/// `folded`: as CompiledModel::folded.
CompiledModel encode(GroundModel& model, PassLog* log = nullptr, bool folded = false);

/// The passes of encoding in their order.
std::vector<PassInfo> encode_passes();

}  // namespace parallax::compiler
