#pragma once

#include "compiler/ground/completion.h"
#include "compiler/ground/possible_atoms.h"

namespace parallax::compiler {

/// Makes tables of the user predicates that the constraints so far settle, wholly or in part: an
/// atom is left out if unit propagation, or the completion of its predicate, makes it false.
/// A predicate that axioms about time speak of is completed later, and gets no table by completion.
/// Predicates over more than 200,000 argument tuples get no table.
void tabulate_predicates(GroundModel& model, const CompletionWriter& completion,
                         PossibleAtoms& possible);

}  // namespace parallax::compiler
