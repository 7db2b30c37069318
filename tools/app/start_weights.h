#pragma once

#include <functional>
#include <string>
#include <vector>

#include "compiler/base/known.h"
#include "compiler/base/result.h"
#include "compiler/pipeline/compile.h"
#include "tools/app/context.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {

/// Reports what is wrong with the formulas of `start_weights`, by themselves, at each.
base::Status check_start_weights(const harness::Scenario& scenario,
                                 const compiler::TypedModel& model, Context& context);

/// Weights of states of the scenario's model by its `start_weights`. Each state is given as its
/// true fluents among `fluents`, sorted; its weight is that of the first formula that holds in it,
/// or 1 if none does. `predicate` tells what the model says of a user's predicate. Reports
/// kQuestionNotObserved for a formula that is not about `fluents` at one timepoint, and
/// kYamlOutOfBounds if all are 0.
base::Result<std::vector<double>> start_weights(
    const ScenarioModel& loaded, const std::vector<std::vector<compiler::FluentId>>& states,
    const std::vector<compiler::FluentId>& fluents,
    const std::function<base::Known(const std::string&)>& predicate, Context& context);

}  // namespace parallax::tools
