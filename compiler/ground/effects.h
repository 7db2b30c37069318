#pragma once

#include "compiler/ground/formula_grounder.h"
#include "compiler/ground/ground_model.h"

namespace parallax::compiler {

/// Grounds the effect axioms into rows (event, fluent, condition) and asserts DEC5 to DEC12 of
/// Mueller 2006 over them. Initiates, Terminates and Releases never become atoms: circumscription
/// makes them the disjunction of their rows, so a fluent's frame axioms mention only the events
/// that can touch it.
void assert_effects(GroundModel& model, FormulaGrounder& grounder);

}  // namespace parallax::compiler
