#pragma once

#include <cstddef>
#include <functional>
#include <set>
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

/// Weights of initial states.
struct StateWeights {
  std::vector<double> weights;  // by state
  std::set<std::size_t> held;   // entries of `start_weights` whose formula holds in one of them
  bool are_all_zero() const;
};

/// Weights of states of the scenario's model by its `start_weights`. Each state is given as its
/// true fluents among `fluents`, sorted; its weight is that of the first formula that holds in it,
/// or 1 if none does. `predicate` tells what the model says of a user's predicate. Reports
/// kQuestionNotObserved for a formula that is not about `fluents` at one timepoint.
base::Result<StateWeights> start_weights(
    const ScenarioModel& loaded, const std::vector<std::vector<compiler::FluentId>>& states,
    const std::vector<compiler::FluentId>& fluents,
    const std::function<base::Known(const std::string&)>& predicate, Context& context);

/// Reports that all of so many initial states have the weight 0.
base::Reported report_no_weight(const ScenarioModel& loaded, std::size_t states, Context& context);

/// Remarks on entries of `start_weights` whose formula holds in no initial state.
void note_idle_weights(const ScenarioModel& loaded, const std::set<std::size_t>& held,
                       Context& context);

}  // namespace parallax::tools
