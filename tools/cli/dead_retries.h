#pragma once

#include "compiler/pipeline/compile.h"

namespace parallax::tools {

/// Warns (W-DEAD) at every perform whose repetitions cannot succeed in the model once it has
/// failed: a sign that the model is too coarse. Does nothing without a plan.
void report_dead_retries(const compiler::Compilation& compilation, base::DiagnosticSink& sink);

}  // namespace parallax::tools
