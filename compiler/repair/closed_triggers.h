#pragma once

#include <set>
#include <string>
#include <vector>

#include "compiler/repair/axiom_form.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// Sentences that let events with triggers happen only where one of these demands them, in a world
/// where no more happens than is demanded. Without `performed` events, by symbol. Empty if there
/// are none.
std::string closed_triggers(const ModelAst& model, const TypedModel& typed,
                            const std::vector<AxiomForm>& forms,
                            const std::set<std::string>& performed);

}  // namespace parallax::compiler
