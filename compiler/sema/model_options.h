#pragma once

#include "compiler/base/diagnostic.h"
#include "compiler/sema/typed_model.h"
#include "compiler/syntax/ast.h"

namespace parallax::compiler {

/// One `option NAME VALUE`. E2011 for unknown names, E2012 for values the option cannot have.
void apply_option(const Ast& ast, const Statement& statement, ModelOptions& options,
                  base::DiagnosticSink& sink);

}  // namespace parallax::compiler
