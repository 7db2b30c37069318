#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "harness/campaign/sample_runner.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {

/// Makes the simulator that the scenario asks for, in a process of its own: the command of the
/// scenario, or else the built-in one, which is the program `worker` (with its first arguments, as
/// in {"parallax", "worker"}) started for the scenario. Raising `stop`, which outlives the factory,
/// ends what a simulator is at.
harness::SimulatorFactory simulator_factory(const ScenarioModel& loaded,
                                            const std::vector<std::string>& worker,
                                            const std::atomic<bool>& stop);

}  // namespace parallax::tools
