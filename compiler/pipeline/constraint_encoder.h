#pragma once

#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/ground/formula_grounder.h"
#include "compiler/sema/check.h"

namespace parallax::compiler {

/// A state constraint with its place: a formula about a final timepoint, called `time` in it.
struct StateConstraint {
  CheckedFormula formula;
  base::SourceRange source;
};

/// Defines an atom `hit` for every timepoint from `first` on: all constraints hold there. An
/// instance that names a timepoint before 0 does not hold.
base::Status encode_constraints(const std::vector<StateConstraint>& constraints, Timepoint first,
                                GroundModel& model, FormulaGrounder& grounder,
                                base::DiagnosticSink& sink);

}  // namespace parallax::compiler
