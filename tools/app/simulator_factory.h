#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "harness/campaign/sample_runner.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {

/// Makes the simulator that the scenario asks for. A world that is a model is simulated in this
/// process, any other in a process of its own: the command of the scenario, or else the built-in
/// simulator, which is the program `worker` (with its first arguments, as in {"parallax",
/// "worker"}) started for the scenario. The words of `supervisor` precede a command of the
/// scenario: a program that, when it ends, also ends everything that it has started. Raising
/// `stop`, which outlives the factory, interrupts the simulator. The caller checks whether the
/// command may be started (docs/reference/trust.md).
harness::SimulatorFactory simulator_factory(const ScenarioModel& loaded,
                                            const std::vector<std::string>& worker,
                                            const std::atomic<bool>& stop,
                                            const std::vector<std::string>& supervisor = {});

}  // namespace parallax::tools
