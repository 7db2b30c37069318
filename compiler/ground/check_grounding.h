#pragma once

#include "compiler/base/diagnostic.h"
#include "compiler/ground/universe.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// Reports what ground_model reports, and leaves out the passes that have nothing to report.
base::Status check_grounding(const TypedModel& model, const GroundOptions& options,
                             base::DiagnosticSink& sink);

}  // namespace parallax::compiler
