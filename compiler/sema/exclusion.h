#pragma once

#include "compiler/base/diagnostic.h"
#include "compiler/sema/declarations.h"
#include "compiler/sema/elaborator.h"
#include "compiler/sema/typed_model.h"
#include "compiler/syntax/ast.h"

namespace parallax::compiler {

/// Expands `mutex A, B, ...` into `[vars,time] !A(..) | !B(..)` for each pair of different symbols,
/// and `xor` also into `[vars,time] A(..) | B(..) | ...`. In a pair the n-th
/// argument of a sort is the same variable in both symbols, also where they have different numbers
/// of arguments: two events of one agent exclude each other, those of two agents do not. In the
/// disjunction of `xor` a symbol's only argument of a sort is not shared with one of several.
/// `position` is that of the statement in ModelAst::order.
void add_exclusion(const Ast& ast, const Statement& statement, std::size_t position,
                   const IgnoredNames& ignored, Elaborator& elaborator, TypedModel& model,
                   base::DiagnosticSink& sink);

}  // namespace parallax::compiler
