#pragma once

#include <cstdint>
#include <string_view>

#include "compiler/base/diagnostic.h"
#include "compiler/base/source_file.h"
#include "compiler/syntax/ast.h"

namespace parallax::compiler {

/// How other languages write what this one has: `=>`, `and`, `//`. The parser names the right
/// spelling (E1020) and goes on as if it stood there.
struct ForeignSpelling {
  enum class Kind : std::uint8_t { kOperator, kPrefix, kComment, kQuantifier };
  std::string_view text;
  std::string_view meaning;
  std::string_view own;  // the right spelling
  Kind kind = Kind::kOperator;
  Operator op = Operator::kAnd;
};

/// The sign that `text` begins with, if it is one that no formula can contain.
const ForeignSpelling* foreign_sign(std::string_view text);
/// The word for a connective or quantifier. A name like any other where it is no operator.
const ForeignSpelling* foreign_word(std::string_view word);
/// Signs that are foreign in some places only: `,` between formulas, `%` in front of a comment.
const ForeignSpelling& foreign_comma();
const ForeignSpelling& foreign_percent();
/// Does the line, which begins with a foreign word, hold something that no declaration of constants
/// can?
bool is_foreign_formula(std::string_view line);

void report_foreign(const ForeignSpelling& spelling, const base::SourceRange& range,
                    base::DiagnosticSink& sink);

}  // namespace parallax::compiler
