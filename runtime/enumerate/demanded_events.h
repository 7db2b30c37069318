#pragma once

#include <vector>

#include "compiler/artifact/compiled_model.h"

namespace parallax::runtime {

/// The events that an axiom can demand (`... -> Happens(Slam(),time)`), ascending: in the clauses
/// of axioms they stand without a negation. That one would explain a change of state (frame axioms)
/// is no demand. What nobody performs and nothing demands does not happen; what something can
/// demand happens where it does.
std::vector<compiler::EventId> demandable_events(const compiler::CompiledModel& model);

}  // namespace parallax::runtime
