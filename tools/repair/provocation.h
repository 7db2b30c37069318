#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "compiler/base/json.h"
#include "harness/campaign/sample_runner.h"
#include "tools/app/recorded_run.h"
#include "tools/repair/explorer.h"

namespace parallax::tools {

/// The folder in a run folder with the simulations of provoked events.
inline constexpr const char* kProvoked = "provoked";

/// An event that the model allows, and its outcome in the world.
struct ProvokedEvent {
  std::string event;
  std::vector<std::string> after;  // the events before it
  std::string reason;              // of a refusal, in the world's words; empty: it was performed
  bool changes_nothing = false;    // refused, and the model says that nothing changes
};

struct Provocation {
  std::int64_t allowed = 0;    // pairs of a state that runs came to and an event allowed there
  std::int64_t made = 0;       // of them were simulated
  std::int64_t unreached = 0;  // of those did not come to the state
  std::vector<ProvokedEvent> refused;    // the world does not do it
  std::vector<ProvokedEvent> otherwise;  // the model cannot have what is seen after it
  std::vector<std::string> skipped;

  /// Does the world agree with the model on all that was seen?
  bool is_clean() const;
};

struct ProvokeOptions {
  std::int64_t most = 100;  // simulations
  std::uint64_t seed = 1;
  std::int64_t jobs = 1;
  std::function<base::Result<harness::SimulatorFactory>(const ScenarioModel&)> simulator;
  std::function<void(const harness::CampaignProgress&)> progress;
};

/// Performs events that the model allows and no recorded run performed, each in a state that a run
/// came to, and records that in RUN_DIR/provoked. States come in the order of their timepoints, and
/// no event gets its second one before each had its first. `loaded` is the scenario as it was run.
/// Reports what loading it for closed loop, reading the runs and starting the simulator report.
base::Result<Provocation> provoke(const ScenarioModel& loaded, const std::filesystem::path& run_dir,
                                  const ProvokeOptions& options, Context& context);

std::string provocation_text(const Provocation& provocation);
nlohmann::ordered_json provocation_json(const Provocation& provocation);

}  // namespace parallax::tools
