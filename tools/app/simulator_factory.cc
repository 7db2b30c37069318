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
  harness::ProcessOptions options;
  options.command = spec.command;
  if (options.command.empty()) {
    options.command = worker;
    options.command.insert(options.command.end(), {"--scenario-hash", loaded.scenario_hash, "--",
                                                   loaded.scenario.file.string()});
  } else {
    options.command.insert(options.command.begin(), supervisor.begin(), supervisor.end());
  }
  options.hello_timeout_s = spec.hello_timeout_s;
  options.reset_timeout_s = spec.reset_timeout_s;
  options.act_timeout_s = spec.act_timeout_s;
  options.observe_timeout_s = spec.observe_timeout_s;
  options.close_timeout_s = spec.close_timeout_s;
  options.min_real_time_factor = spec.min_real_time_factor;
  options.memory_mb = spec.memory_mb;
  options.recycle_after = spec.recycle_after;
  options.stop = &stop;
  return [options] { return std::make_unique<harness::ProcessSimulator>(options); };
}

}  // namespace parallax::tools
