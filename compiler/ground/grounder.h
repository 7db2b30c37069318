#pragma once

#include "compiler/base/diagnostic.h"
#include "compiler/ground/ground_model.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// Expands the whole typed model over its finite domains: axioms, effect axioms, DEC5 to DEC12.
/// `model` must outlive the result. Several errors per run: kFormulaIsFalse, kNothingToSay,
/// kTooManyInstances, kDivisionByZero, kDomainTooLarge, ...
base::Result<GroundModel> ground_model(const TypedModel& model, const GroundOptions& options,
                                       base::DiagnosticSink& sink);

}  // namespace parallax::compiler
