#pragma once

#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/ground/ground_model.h"
#include "compiler/ground/pass.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// Expands the whole typed model over its finite domains: axioms, effect axioms, DEC5 to DEC12.
/// `model` must outlive the result. Several errors per run: kFormulaIsFalse, kNothingToSay,
/// kTooManyInstances, kDivisionByZero, kDomainTooLarge, ... `log` may be null.
base::Result<GroundModel> ground_model(const TypedModel& model, const GroundOptions& options,
                                       base::DiagnosticSink& sink, PassLog* log = nullptr);

/// The passes of grounding in their order.
std::vector<PassInfo> ground_passes();

}  // namespace parallax::compiler
