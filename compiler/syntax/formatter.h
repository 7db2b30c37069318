#pragma once

#include <string>

#include "compiler/base/diagnostic.h"
#include "compiler/base/result.h"
#include "compiler/base/source_file.h"
#include "compiler/syntax/ast.h"

namespace parallax::compiler {

/// The `.e` text in its standard layout. Statements are written as the printer writes them;
/// formulas keep their parentheses, get blanks around connectives alone, and are broken at
/// connectives where a line would exceed kLayoutWidth. Comments stay where they are, before, behind
/// or inside a formula; a formula with a comment inside keeps its lines. Runs of blank lines become
/// one; lines end with a line feed.
///
/// Formatting the result changes nothing, and parsing it gives the same statements
/// (same_statements), which is checked. Fails if the text has a syntax error (E10xx). Linear.
base::Result<std::string> format_text(base::FileId file, const base::SourceFiles& files,
                                      base::DiagnosticSink& sink);

/// True if the texts say the same, wherever it stands in them.
bool same_statements(const Ast& a, const Ast& b);

}  // namespace parallax::compiler
