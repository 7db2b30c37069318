#pragma once

#include <span>
#include <string>

#include "compiler/formula/formula.h"
#include "compiler/ground/ground_model.h"

namespace parallax::compiler {

/// `HoldsAt(Alive(),0)`; `aux7` for an atom without a name, by its variable.
std::string atom_text(const GroundModel& model, std::int32_t variable);

/// Prints the model's formulas. `model` outlives it.
FormulaText formula_text(const GroundModel& model);

/// `m.e:5 axiom`; without files, or without a place, `axiom`.
std::string origin_text(const Origin& origin, const base::SourceFiles* files);

/// `m.e:5 axiom: HoldsAt(F(),0) | ...` a line for each constraint, in order; those that hold at
/// every timepoint as they stand at 0, with ` (every timepoint, width 1)`. Then the parts.
std::string constraint_lines(const GroundModel& model, std::span<const Constraint> constraints,
                             FormulaText& formulas, const base::SourceFiles* files);

/// All that grounding knows so far, for people: which fluents and events are left out, the effect
/// rows, the constraints. Deterministic; linear in the model.
std::string ground_text(const GroundModel& model, const EffectRows& rows,
                        const base::SourceFiles* files);

}  // namespace parallax::compiler
