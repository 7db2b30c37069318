#pragma once

#include <set>
#include <string>

#include "compiler/pipeline/plan_questions.h"
#include "compiler/plan/plan_graph.h"
#include "tools/app/observed_path.h"

namespace parallax::tools {

/// What the outcome of a perform says of fluents that nobody observes. The binding table says when
/// a perform succeeds: that `Detect(bowl)` found bowl1 says that `Visible(bowl1)` held. Adds to the
/// states of an executed path the fluents of success formulas that each way of reading an outcome
/// makes the same. `model` is the one whose ids the path has; `symbols` gets the fluent symbols of
/// which something was found out.
void add_outcome_facts(const compiler::PlanGraph& graph, const compiler::PlanQuestions& questions,
                       const compiler::CompiledModel& model, ObservedPath& path,
                       std::set<std::string>& symbols);

}  // namespace parallax::tools
