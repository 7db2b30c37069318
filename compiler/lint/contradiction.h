#pragma once

#include <optional>
#include <string>

#include "compiler/lint/lint_context.h"

namespace parallax::compiler {

/// Why the condition cannot hold in any instance, as the end of a sentence; nothing where that is
/// not plain from the condition alone. Looked at are its conjuncts, also those below `{..}`: a term
/// compared with itself, two constants, a term equated with different constants or bounded by
/// numbers that leave nothing between them, a literal beside its negation. Sound: what is named
/// can indeed not hold. Linear in the condition but for look-ups.
std::optional<std::string> contradiction(const LintContext& context, TypedFormulaId condition);

}  // namespace parallax::compiler
