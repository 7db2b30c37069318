#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/reference/reference_evaluator.h"
#include "compiler/sema/typed_model.h"
#include "compiler/syntax/loader.h"

namespace parallax::test {

/// A `mutex` or `xor` statement as it was parsed, before anybody expands it.
struct StatedExclusion {
  bool is_xor = false;
  std::vector<compiler::SymbolId> names;  // each once
  base::SourceRange source;
};

std::vector<StatedExclusion> stated_exclusions(const compiler::ModelAst& ast,
                                               const compiler::TypedModel& model);

/// Is the statement true in the trace, by its definition: at each timepoint, whatever objects are
/// chosen, at most one of any two names is true of them, where the n-th argument of a sort is one
/// object for both names? With `xor` some name is true, where a name's only argument of a sort and
/// the first of several are chosen apart. Statements over predicates are not looked at.
bool satisfies(const StatedExclusion& exclusion, const compiler::TypedModel& model,
               const compiler::Valuation& trace);

}  // namespace parallax::test
