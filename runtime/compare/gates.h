#pragma once

#include <vector>

#include "runtime/compare/definitions.h"

namespace parallax::runtime {

/// Finds the auxiliaries that the model's definitions make conjunctions, and sets their role. The
/// first literal of a definition is the auxiliary's own. An auxiliary that is defined in one
/// polarity only is used in that one only; anything else is left alone. Linear in the clauses.
void find_gates(const compiler::CompiledModel& model, const std::vector<bool>& observed,
                Definitions& out);

}  // namespace parallax::runtime
