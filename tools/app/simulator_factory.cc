#include "tools/app/simulator_factory.h"

#include <memory>

#include "harness/simulator/process_simulator.h"

namespace parallax::tools {

harness::SimulatorFactory simulator_factory(const ScenarioModel& loaded,
                                            const std::vector<std::string>& worker,
                                            const std::atomic<bool>& stop) {
  const auto& spec = loaded.scenario.simulator;
  harness::ProcessOptions options;
  options.command = spec.command;
  if (options.command.empty()) {
    options.command = worker;
    options.command.insert(options.command.end(), {loaded.scenario.file.string(), "--scenario-hash",
                                                   loaded.scenario_hash});
  }
  options.hello_timeout_s = spec.hello_timeout_s;
  options.reset_timeout_s = spec.reset_timeout_s;
  options.act_timeout_s = spec.act_timeout_s;
  options.observe_timeout_s = spec.observe_timeout_s;
  options.close_timeout_s = spec.close_timeout_s;
  options.min_real_time_factor = spec.min_real_time_factor;
  options.recycle_after = spec.recycle_after;
  options.stop = &stop;
  return [options] { return std::make_unique<harness::ProcessSimulator>(options); };
}

}  // namespace parallax::tools
