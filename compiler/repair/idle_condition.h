#pragma once

#include <string>
#include <vector>

#include "compiler/repair/axiom_form.h"

namespace parallax::compiler {

/// A condition, as `print` writes it, that an axiom about effects has already, or after which it
/// says nothing: the opposite of one that it has, or that its only effect is there before. (Of a
/// fluent that some axiom releases the latter does say something: it keeps its value from there.)
/// `forms` are all of the model.
bool is_idle_condition(const ModelAst& model, const std::vector<AxiomForm>& forms,
                       const AxiomForm& axiom, const std::string& condition);

}  // namespace parallax::compiler
