#pragma once

#include <cstdint>
#include <vector>

#include "compiler/base/result.h"
#include "compiler/pipeline/compile.h"
#include "compiler/sema/check.h"

namespace parallax::compiler {

/// May temporal operators stand in them?
enum class Constraints : std::uint8_t { kStates, kTraces };

/// Checks the constraints against the model; they become part of the model's stores. Reports the
/// errors of each at its place.
base::Result<std::vector<StateConstraint>> check_constraints(
    const std::vector<ConstraintText>& constraints, Constraints about, TypedModel& model,
    const base::SourceFiles& files, base::DiagnosticSink& sink);

}  // namespace parallax::compiler
