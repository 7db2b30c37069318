#pragma once

#include "harness/campaign/campaign.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {

/// Makes the simulator that the scenario asks for: the built-in one is this program, started as
/// `parallax worker SCENARIO`; an external one is the command of the scenario.
harness::SimulatorFactory simulator_factory(const ScenarioModel& loaded);

}  // namespace parallax::tools
