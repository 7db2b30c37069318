#pragma once

#include "tools/repair/experiments.h"
#include "tools/repair/repair_input.h"

namespace parallax::tools {

/// Runs of a scenario that the key `validate` names.
struct OtherPlan {
  std::string scenario;
  std::vector<Evidence> runs;  // none: it could not be run
};

/// Runs the scenarios that `validate` names, with `model` for their model: in closed loop what is
/// seen depends on the world and the plan.
std::vector<OtherPlan> runs_of_other_plans(const std::vector<harness::LocatedText>& scenarios,
                                           const std::string& model,
                                           const ExperimentOptions& options, Context& context);

/// The scenario once more, for closed loop. None where its plan cannot be executed; nothing is
/// reported then.
std::optional<ScenarioModel> load_to_execute(const RepairInput& input, Context& context);

/// Simulates random sequences of the model's events in the world of the run, from random initial
/// states and from where the plan's executions came: runs that no proposal was made for. The same
/// for the same run folder, whatever else was simulated. Empty where the world is no model, which
/// would cost more, where there is no plan, or where no simulations may be made. Reports what
/// loading the scenario and starting the simulator report.
base::Result<RandomSequences> random_sequences(const RepairInput& input,
                                               const ExperimentOptions& options, Context& context);

}  // namespace parallax::tools
