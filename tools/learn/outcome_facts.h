#pragma once

#include <set>
#include <string>

#include "compiler/pipeline/plan_questions.h"
#include "compiler/plan/plan_graph.h"
#include "tools/app/observed_path.h"

namespace parallax::tools {

/// Derives values of unobserved fluents from the outcomes of performs. The binding table says when
/// a perform succeeds: that `Detect(bowl)` found bowl1 says that `Visible(bowl1)` held. Adds to the
/// states of an executed path the fluents of success formulas whose value is the same in each way
/// of reading an outcome. `model` is the one whose ids the path has; `symbols` gets the symbols of
/// the fluents with a derived value.
void add_outcome_facts(const compiler::PlanGraph& graph, const compiler::PlanQuestions& questions,
                       const compiler::CompiledModel& model, ObservedPath& path,
                       std::set<std::string>& symbols);

}  // namespace parallax::tools
