#pragma once

#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "compiler/compare/fact.h"

namespace parallax::compiler {

/// What a compiled model says, without its numbering: options, horizon, ground fluents and events,
/// and the axioms with the number of clauses that came of each. Places are those of the texts.
std::vector<Fact> artifact_facts(const CompiledModel& model);

}  // namespace parallax::compiler
