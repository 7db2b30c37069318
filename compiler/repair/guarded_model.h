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
/// text leaves open, switches each edit on. With all of them false it says what the model says.
/// Any edits can be on together; of kAddCondition those whose effect is on say something.
std::string guarded_text(const ModelAst& model, const TypedModel& typed,
                         const base::SourceFiles& files, const std::vector<AxiomForm>& forms,
                         const std::vector<Edit>& edits);

}  // namespace parallax::compiler
