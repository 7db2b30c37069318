#pragma once

#include <string>

#include "compiler/base/diagnostic.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// Sorts a formula that mentions Initiates, Terminates, Releases, Trajectory or AntiTrajectory
/// into the model's axioms: `[v] c1 -> ([w] c2 -> A & B & ...)` with any nesting becomes an
/// EffectAxiom or TrajectoryAxiom for each conjunct that is such an atom and an Axiom for each that
/// is not. Where conjuncts can name something that does not exist, each of them carries the
/// existence of the others as a condition (`existence_formula`): an instance says all or nothing.
/// Conditions may mention effects (Mueller 2006, section 6.4.1, effect constraints). A
/// formula that mentions them only in conditions, or inside the definition of another predicate,
/// becomes an Axiom with `mentions_effects`. Any other place is an error (E2301), as is a
/// trajectory in a condition (E2303). Mueller 2006, section 2.7.
void add_effect_formula(TypedFormulaId formula, std::string label, TypedModel& model,
                        base::DiagnosticSink& sink);

/// Does Initiates, Terminates or Releases occur anywhere in the formula?
bool mentions_effects(const TypedModel& model, TypedFormulaId formula);

/// Is the axiom the definition of a predicate by effects, `P(..) <-> ..`, as those of Clipped and
/// of ECCausal.e? For completion such a definition gives no reason for the atoms in it.
bool defines_by_effects(const TypedModel& model, const Axiom& axiom);

}  // namespace parallax::compiler
