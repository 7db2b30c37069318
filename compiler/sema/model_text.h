#pragma once

#include <functional>
#include <string>

#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// The formula in the language of models, names resolved, without a final period. No recursion.
std::string to_text(const TypedModel& model, TypedFormulaId formula);
std::string to_text(const TypedModel& model, TermId term);

/// The checked model as a text in the language of models: declarations, then axioms with their
/// labels, effect axioms and trajectories with all conditions joined into one, function tables,
/// completions. `mutex`, `xor` and `ignore` have been carried out. What `leave_out` says yes to is
/// not declared: the built-in foundations. Reading the text again gives the same text.
std::string to_text(const TypedModel& model,
                    const std::function<bool(const base::SourceRange&)>& leave_out);

}  // namespace parallax::compiler
