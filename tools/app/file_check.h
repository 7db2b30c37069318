#pragma once

#include "tools/app/context.h"
#include "tools/app/model_options.h"

namespace parallax::tools {

/// Checks what `options.models` names, as `check` does: each scenario and each compiled model by
/// itself, all other files as one model. Everything is reported into the context's sink; with
/// `options.lint` also what is legal but hardly meant.
void check_files(const ModelOptions& options, Context& context);

}  // namespace parallax::tools
