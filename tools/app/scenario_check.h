#pragma once

#include <string>
#include <vector>

#include "tools/app/scenario_model.h"

namespace parallax::tools {

/// Reports errors that `parallax run` would find before its first simulation, beyond those of
/// loading the scenario: missing constraints, a criterion that cannot be met, a model without an
/// execution, no trace within the horizon, and whatever keeps the first traces from being
/// simulated: their start states, the arguments of their actions, sampling. The built-in simulator
/// is put into a start of each, so starts that are all invalid show; nothing is moved. For a plan
/// that is to be executed, checks its conditions and performs, and the first initial states.
/// Commands of other simulators are not started; what they would report is not checked.
void check_before_run(const ScenarioModel& loaded, Context& context);

/// Reasons, in sentences, why a scenario has no trace: fluents of the constraints that no event of
/// the plan changes, whether any state can meet the constraints, and a horizon that would do. Looks
/// for longer executions up to a bound that follows from the plan.
std::vector<std::string> reasons_for_absence(const ScenarioModel& loaded, Context& context);

}  // namespace parallax::tools
