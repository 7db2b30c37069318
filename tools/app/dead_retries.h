#pragma once

#include "compiler/pipeline/compile.h"
#include "tools/app/context.h"

namespace parallax::tools {

/// Warns (W-DEAD) at every perform whose repetitions cannot succeed in the model once it has
/// failed: a sign that the model is too coarse. Does nothing without a plan.
void report_dead_retries(const compiler::Compilation& compilation, Context& context);

}  // namespace parallax::tools
