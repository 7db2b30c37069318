#pragma once

#include "compiler/base/diagnostic.h"
#include "compiler/sema/typed_model.h"
#include "compiler/syntax/loader.h"

namespace parallax::compiler {

/// All `sort` and `reified sort` statements: names, then parents, then what parents imply. A sort
/// below itself (E2003) loses the parent that closes the circle.
void declare_sorts(const ModelAst& ast, TypedModel& model, base::DiagnosticSink& sink);

/// E2010 for reified sorts whose terms could be nested without end. Needs all symbols.
void check_finite_sorts(const TypedModel& model, base::DiagnosticSink& sink);

/// The sort `word` names, or nothing after an E2001 with a suggestion.
std::optional<SortId> resolve_sort(const Ast& ast, Word word, const TypedModel& model,
                                   base::DiagnosticSink& sink);

}  // namespace parallax::compiler
