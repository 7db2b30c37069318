#pragma once

#include "compiler/pipeline/compile.h"

namespace parallax::compiler {

/// Reports what compile_model reports about a model, for which no clauses are made. The input has
/// no plan, no constraints and no objectives.
base::Status check_texts(const CompileInput& input, base::SourceFiles& files,
                         base::DiagnosticSink& sink);

}  // namespace parallax::compiler
