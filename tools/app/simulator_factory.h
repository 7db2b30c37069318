#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "harness/campaign/sample_runner.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {

/// Makes the simulator that the scenario asks for: a world that is a model in this process, any
/// other in a process of its own, which is the command of the
/// scenario, or else the built-in one, which is the program `worker` (with its first arguments, as
/// in {"parallax", "worker"}) started for the scenario. Words of `supervisor` are put before a
/// command of the scenario: a program that ends with it all that it has started. Raising `stop`,
/// which outlives the factory, ends what a simulator is at. Whether the command may be started is
/// for the caller to ask (docs/trust.md).
harness::SimulatorFactory simulator_factory(const ScenarioModel& loaded,
                                            const std::vector<std::string>& worker,
                                            const std::atomic<bool>& stop,
                                            const std::vector<std::string>& supervisor = {});

}  // namespace parallax::tools
