#include <unistd.h>

#include <memory>

#include "compiler/base/codes/campaigns.h"
#include "harness/campaign/campaign.h"
#include "harness/config/scenario.h"
#include "harness/robot/ode_simulator.h"
#include "harness/simulator/worker.h"
#include "tools/cli/command.h"

namespace parallax::tools {

Command worker_command() {
  struct Options {
    std::string scenario;
    std::string hash;
    bool half_step = false;
  };
  auto options = std::make_shared<Options>();
  OptionTable command("worker",
                      "Serve the built-in simulator of a scenario on standard input and output");
  command.hide();  // started by `run`; not meant to be typed
  command.option("scenario", options->scenario).required();
  command.option("--scenario-hash", options->hash);
  command.flag("--half-step", options->half_step, "Simulate with half the scenario's step");
  return {std::move(command), [options](Invocation& invocation) {
            auto scenario =
                harness::load_scenario(options->scenario, invocation.files(), invocation.sink(),
                                       invocation.form().allow_outside);
            if (!scenario) return 0;
            // The parent read the same file a moment ago; an edit in between must not go unseen.
            if (!options->hash.empty() &&
                harness::hash_of_sources(invocation.files()) != options->hash) {
              invocation.sink().error_about(codes::kScenarioChanged, options->scenario);
              return 0;
            }
            if (options->half_step) scenario->world.solver.timestep_s /= 2.0;
            harness::OdeSimulator simulator(scenario->world);
            return harness::serve(simulator, STDIN_FILENO, STDOUT_FILENO) == 0 ? 0 : 5;
          }};
}

}  // namespace parallax::tools
