#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "harness/campaign/campaign.h"
#include "harness/cluster/program_identity.h"
#include "harness/config/load_limits.h"
#include "harness/config/scenario.h"
#include "harness/robot/guarded_simulator.h"
#include "harness/simulator/worker.h"
#include "tools/app/own_identity.h"
#include "tools/app/simulator_factory.h"
#include "tools/app/world_model.h"
#include "tools/cli/command.h"
#include "tools/cli/limits.h"
#include "tools/cli/shared_options.h"

namespace parallax::tools {
namespace {

struct WorkerOptions {
  std::string scenario, hash;
  std::string engine;  // empty: as the scenario says
  bool half_step = false;
  bool elsewhere = false;  // what follows is of such a worker
  std::string folder, world_hash;
  std::int64_t world_horizon = 0;
  double beat_s = 0.0;
  CommandPermission commands;
};

constexpr int kPeerGone = 5;

/// Serves the whole simulator of a scenario to another machine, in processes of its own as there.
/// Its failures are reported in an answer, and are not failures of the worker.
int serve_elsewhere(const WorkerOptions& options, ScenarioModel loaded, Invocation& invocation) {
  const auto& spec = loaded.scenario.simulator;
  if (!spec.models.empty()) {
    const auto before = invocation.files().size();
    // The horizon of the run, which may not be the written one.
    loaded.scenario.horizon = static_cast<std::int32_t>(options.world_horizon);
    auto world = load_world_model(loaded.scenario, invocation);
    if (!world) return 0;
    if (harness::hash_of_sources(invocation.files(), before) != options.world_hash) {
      invocation.sink().error_about(codes::kScenarioChanged, spec.models.front().text);
      return 0;
    }
    loaded.world = *std::move(world);
  }
  const auto make = permitted_simulator(loaded, options.commands.allow, invocation);
  if (!make) return 0;
  harness::ServeOptions how;
  how.greeting = harness::greeting_line(own_identity(loaded.scenario));
  how.beat_s = options.beat_s;
  how.stop = &stop_flag();
  const auto simulator = (*make)();
  return harness::serve(*simulator, STDIN_FILENO, STDOUT_FILENO, how) == 0 ? 0 : kPeerGone;
}

int serve_scenario(const WorkerOptions& options, Invocation& invocation) {
  if (!options.folder.empty() && ::chdir(options.folder.c_str()) != 0) {
    invocation.sink().error_about(
        codes::kUsage, options.folder,
        fmt::format("--folder: it cannot be entered here: {}", std::strerror(errno)));
    return 0;
  }
  auto scenario = harness::load_scenario(
      options.scenario, invocation.files(), invocation.sink(),
      harness::LoadLimits{invocation.form().allow_outside, &invocation.stop()});
  if (!scenario) return 0;
  // Our parent read the same file a moment ago; an edit in between must be noticed.
  const auto hash = harness::hash_of_sources(invocation.files());
  if (!options.hash.empty() && hash != options.hash) {
    invocation.sink().error_about(codes::kScenarioChanged, options.scenario);
    return 0;
  }
  if (options.elsewhere) {
    return serve_elsewhere(options, {*std::move(scenario), {}, {}, hash}, invocation);
  }
  harness::kEngineWords.take(options.engine, scenario->world.engine);
  if (options.half_step) scenario->world.solver.timestep_s /= 2.0;
  harness::GuardedSimulator simulator(scenario->world);
  return harness::serve(simulator, STDIN_FILENO, STDOUT_FILENO) == 0 ? 0 : kPeerGone;
}

}  // namespace

Command worker_command() {
  auto options = std::make_shared<WorkerOptions>();
  OptionTable command("worker", "Serve the simulator of a scenario on standard input and output");
  command.hide();  // started by `run`; not meant to be typed
  command.option("scenario", options->scenario).required().file({"yaml"});
  command.option("--scenario-hash", options->hash);
  command.option("--engine", options->engine, "Simulate with this engine")
      .check(one_of(harness::kEngineWords));
  command.flag("--half-step", options->half_step, "Simulate with half the scenario's step");
  command
      .flag("--elsewhere", options->elsewhere,
            "Serve another machine: identify the program, and give signs of life")
      .details("Also runs whatever simulator the scenario names, in a process of its own.");
  command.option("--folder", options->folder, "Of --elsewhere: paths start here").folder();
  command.option("--world-hash", options->world_hash, "Of --elsewhere: of a world that is a model");
  command.option("--world-horizon", options->world_horizon, "Of --elsewhere: likewise, of the run")
      .check(WholeNumber{0, 1'000'000});
  command
      .option("--beat", options->beat_s, "Of --elsewhere: seconds between signs of life; 0: none")
      .check(FiniteNumber{0.0, 86'400.0});
  add_command_options(command, options->commands, false);
  return command_of(std::move(command), options, serve_scenario);
}

}  // namespace parallax::tools
