#include "tools/app/simulator_factory.h"

#include <memory>

#include "harness/discrete/model_simulator.h"
#include "harness/simulator/process_simulator.h"

namespace parallax::tools {

harness::SimulatorFactory simulator_factory(const ScenarioModel& loaded,
                                            const std::vector<std::string>& worker,
                                            const std::atomic<bool>& stop,
                                            const std::vector<std::string>& supervisor) {
  const auto& spec = loaded.scenario.simulator;
  if (loaded.world) {
    return [world = loaded.world, &stop] {
      return std::make_unique<harness::ModelSimulator>(world, &stop);
    };
  }
  harness::ProcessOptions options{spec, spec.command, spec.recycle_after, &stop};
  if (options.command.empty()) {
    options.command = worker;
    options.command.insert(options.command.end(), {"--scenario-hash", loaded.scenario_hash, "--",
                                                   loaded.scenario.file.string()});
  } else {
    options.command.insert(options.command.begin(), supervisor.begin(), supervisor.end());
  }
  return [options] { return std::make_unique<harness::ProcessSimulator>(options); };
}

}  // namespace parallax::tools
