#pragma once

#include "tools/repair/experiments.h"
#include "tools/repair/repair_input.h"

namespace parallax::tools {

/// Simulates random sequences of the model's events in the world of the run, from random initial
/// states and from where the plan's executions came: runs that no proposal was made for. The same
/// for the same run folder, whatever else was simulated. Empty where the world is no model, which
/// would cost more, where there is no plan, or where no simulations may be made. Reports what
/// loading the scenario and starting the simulator report.
base::Result<RandomSequences> random_sequences(const RepairInput& input,
                                               const ExperimentOptions& options, Context& context);

}  // namespace parallax::tools
