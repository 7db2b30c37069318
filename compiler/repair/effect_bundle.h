#pragma once

#include <vector>

#include "compiler/repair/edit_grammar.h"

namespace parallax::compiler {

/// Effects that belong together because one step showed them together: a thing slips from the hand
/// and lies on the floor. Each bundle is one new axiom of kAddEffect,
/// `[v] HoldsAt(F(v),time) & ... -> Terminates(E,F(v),time) & Initiates(E,G(v),time)`, about the
/// inertial fluents that changed at a step of the scope against what the model says. What holds no
/// longer is the condition; its arguments may be variables, all others are those of the event or
/// constants. With `open_outcomes` also with Releases for all of them. Behind each bundle without
/// avoidable constants come further conditions of it (kAddCondition), whose `of` is the place of
/// the bundle in `edits`. Appends to `edits`.
void add_effect_bundles(const ModelAst& model, const TypedModel& typed,
                        const std::vector<AxiomForm>& forms, const EditScope& scope,
                        std::vector<Edit>& edits);

}  // namespace parallax::compiler
