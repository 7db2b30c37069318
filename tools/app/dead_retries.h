#pragma once

#include "compiler/pipeline/compile.h"
#include "tools/app/context.h"

namespace parallax::tools {

/// Warns (W-DEAD) at every perform whose repetitions cannot succeed in the model once it has
/// failed: a sign that the model is too coarse. Does nothing without a plan.
void report_dead_retries(const compiler::Compilation& compilation, Context& context);

/// Reports failure handlers (W-HANDLER) that no execution of the model comes to, because no perform
/// in their body can fail with their class, or none does in the model.
void report_dead_handlers(const compiler::Compilation& compilation, Context& context);

}  // namespace parallax::tools
