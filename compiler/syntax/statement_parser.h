#pragma once

#include "compiler/base/diagnostic.h"
#include "compiler/syntax/ast.h"

namespace parallax::compiler {

/// Parses the statement on `line` (one line without its comment) into `ast`. `text` is the text of
/// the file. What is malformed is reported (E1010, E1011) and left out.
void parse_statement(Ast& ast, std::string_view text, Word line, base::DiagnosticSink& sink);

}  // namespace parallax::compiler
