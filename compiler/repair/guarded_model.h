#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "compiler/repair/axiom_form.h"
#include "compiler/repair/edit_grammar.h"

namespace parallax::compiler {

/// The predicate that stands for an edit in a guarded model: true where the edit is made.
std::string edit_predicate(std::size_t edit);

/// The model together with every edit of it as one text: a predicate without arguments, which the
/// text leaves open, switches each edit on. With all of them false the text is equivalent to the
/// model. Any edits can be on together; an edit of kAddCondition has an effect only if the effect
/// that it belongs to is on.
std::string guarded_text(const ModelAst& model, const TypedModel& typed,
                         const base::SourceFiles& files, const std::vector<AxiomForm>& forms,
                         const std::vector<Edit>& edits);

}  // namespace parallax::compiler
