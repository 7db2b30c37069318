#pragma once

#include <string>
#include <vector>

#include "tools/app/scenario_model.h"

namespace parallax::tools {

/// What `parallax run` would find before its first simulation, beyond what loading the scenario
/// finds: missing constraints, a criterion that cannot be met, a model without an execution, no
/// trace within the horizon, and whatever keeps the first traces from being simulated: their start
/// states, the arguments of their actions, sampling. The built-in simulator is put into a start of
/// each, so starts that are all invalid show; nothing is moved. Of a plan that is to be executed:
/// what it asks and performs, and the first initial states. Commands of other simulators are
/// not started; what they would say is not checked.
void check_before_run(const ScenarioModel& loaded, Context& context);

/// Of a scenario without a trace: which fluents of the constraints no event of the plan changes,
/// whether a state can meet them at all, and which horizon would do. In sentences; looks for longer
/// executions up to a bound that follows from the plan.
std::vector<std::string> reasons_for_absence(const ScenarioModel& loaded, Context& context);

}  // namespace parallax::tools
