#pragma once

#include <vector>

#include "compiler/base/result.h"
#include "compiler/pipeline/compile.h"
#include "compiler/sema/check.h"

namespace parallax::compiler {

/// A formula about a state with its place; the timepoint of the state is called `time` in it.
struct StateConstraint {
  CheckedFormula formula;
  base::SourceRange source;
};

/// Checks them against the model, in whose stores they are afterwards. Reports what is wrong with
/// any of them at its place.
base::Result<std::vector<StateConstraint>> check_constraints(
    const std::vector<ConstraintText>& constraints, TypedModel& model,
    const base::SourceFiles& files, base::DiagnosticSink& sink);

}  // namespace parallax::compiler
