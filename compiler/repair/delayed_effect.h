#pragma once

#include <vector>

#include "compiler/repair/edit_grammar.h"

namespace parallax::compiler {

/// Effects that came later than the model says (EditScope::Late): instead of
/// `condition -> Initiates(E,F,time)` what happens k steps behind E has the effect,
/// `Happens(E,time-k) & condition at time-k -> Initiates(E2,F,time)`, a sentence for each event E2
/// that was seen there. Of axioms with one effect. Appends to `edits`.
void add_delays(const ModelAst& model, const TypedModel& typed, const std::vector<AxiomForm>& forms,
                const EditScope& scope, std::vector<Edit>& edits);

}  // namespace parallax::compiler
