#pragma once

#include <string>
#include <vector>

#include "compiler/base/result.h"
#include "compiler/ground/formula_grounder.h"
#include "compiler/sema/check.h"

namespace parallax::compiler {

/// An objective: `count FORMULA`, `sum TERM: FORMULA`, or several of these separated by commas, to
/// be added up.
struct CheckedObjective {
  std::string text;  // on one line
  base::SourceRange source;
  std::vector<CheckedSum> sums;
};

/// Parses the objective that stands in `range` and checks it against the model; it becomes part of
/// the model's stores. Reports E1024, and errors in formulas and terms.
base::Result<CheckedObjective> check_objective(const base::SourceRange& range, TypedModel& model,
                                               const base::SourceFiles& files,
                                               base::DiagnosticSink& sink);

/// Grounds it: an assignment of the free variables counts if all that it names exists, and in
/// traces that have all timepoints that it names. Adds the objective to the model, and a definition
/// for each formula that is no literal. E3017 if no atom counts, E3018 if weights are too large.
base::Status encode_objective(const CheckedObjective& objective, GroundModel& model,
                              FormulaGrounder& grounder, base::DiagnosticSink& sink);

}  // namespace parallax::compiler
