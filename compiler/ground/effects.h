#pragma once

#include "compiler/ground/effect_rows.h"
#include "compiler/ground/formula_grounder.h"
#include "compiler/ground/ground_model.h"

namespace parallax::compiler {

/// Expands every effect axiom at every timepoint before the last. Errors are the grounder's.
EffectRows ground_effects(GroundModel& model, FormulaGrounder& grounder);

/// Asserts DEC5 to DEC12 of Mueller 2006 over the rows. Initiates, Terminates and Releases never
/// become atoms: circumscription makes them the disjunction of their rows, so a fluent's frame
/// axioms mention only the events that can touch it.
void assert_inertia(GroundModel& model, const EffectRows& rows);

/// Asserts DEC3 and DEC4: what a trajectory axiom says of the time between the event that starts
/// its fluent and the first one that stops it. Quadratic in the horizon.
void assert_trajectories(GroundModel& model, const EffectRows& rows, FormulaGrounder& grounder);

}  // namespace parallax::compiler
