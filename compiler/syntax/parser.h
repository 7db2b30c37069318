#pragma once

#include <string_view>

#include "compiler/base/diagnostic.h"
#include "compiler/base/result.h"
#include "compiler/base/source_file.h"
#include "compiler/syntax/ast.h"

namespace parallax::compiler {

/// Deepest tree, and most brackets open at once, that the parser accepts (E1009). It uses no
/// recursion itself; the limit protects the later stages.
inline constexpr std::uint32_t kMaxFormulaDepth = 20'000;

/// Parses a whole `.e` text. Never fails: wrong text is reported and left out, the rest is in the
/// Ast. Linear in the length of the text.
///
/// Statements take one line. A line is a statement if it starts with a keyword, or with a
/// lower-case word that is followed by a name (a declaration of constants); all other lines are
/// formula text. A statement inside an unfinished formula ends the formula with an error (E1007).
Ast parse_file(base::FileId file, const base::SourceFiles& files, base::DiagnosticSink& sink);

struct ParsedFormula {
  Ast ast;
  NodeId root;
};

/// Parses one formula that stands in `range` of any file (a YAML value, a plan's binding). The
/// final period may be missing; labels and statements are not recognised. Locations are those of
/// the file. E10xx, also if something follows the formula.
base::Result<ParsedFormula> parse_formula(const base::SourceRange& range,
                                          const base::SourceFiles& files,
                                          base::DiagnosticSink& sink);
/// The same for the whole text of a file.
base::Result<ParsedFormula> parse_formula(base::FileId file, const base::SourceFiles& files,
                                          base::DiagnosticSink& sink);

/// The same, and temporal operators may stand in it (docs/reference/model_language.md).
base::Result<ParsedFormula> parse_temporal_formula(const base::SourceRange& range,
                                                   const base::SourceFiles& files,
                                                   base::DiagnosticSink& sink);

/// A formula of a plan's binding table: `?arm` is a name, and `exists i, j.` and `forall i.` are
/// quantifiers beside `{i,j}` and `[i]`. `text` is the text of the range's file, or as long, with
/// blanks for text outside the table. The Ast views it.
base::Result<ParsedFormula> parse_binding_formula(const base::SourceRange& range,
                                                  std::string_view text,
                                                  base::DiagnosticSink& sink);

}  // namespace parallax::compiler
