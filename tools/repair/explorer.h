#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "harness/campaign/campaign.h"
#include "harness/campaign/sample_runner.h"
#include "tools/app/context.h"
#include "tools/app/scenario_model.h"
#include "tools/repair/evidence.h"

namespace parallax::tools {

struct ExploreOptions {
  std::uint64_t seed = 1;
  std::int64_t jobs = 1;
  std::int64_t first = 1, count = 1;  // numbers of the sequences
  /// Draws from all events of the model that the world can be asked for, not the plan's alone.
  bool all_events = false;
  /// Where the sequences begin, by what holds; empty: in the initial states of the model.
  std::vector<Evidence::State> starts = {};
  /// Instead of random ones: the events of the sequence with a number, and where it begins.
  struct Sequence {
    Evidence::State start;
    std::vector<std::string> events;
  };
  std::function<Sequence(std::int64_t)> given = {};
  std::filesystem::path run_dir;
  std::string tool_version;
  std::function<void(const harness::CampaignProgress&)> progress;
};

struct Explored {
  std::vector<Evidence> runs;        // ids "7.1": the number of the sequence, and its sample
  std::int64_t made = 0;             // simulations
  std::vector<std::string> skipped;  // sequences that could not be simulated, and why
  bool of_plan = false;              // the model has other events, and the plan's alone were drawn
};

/// The events, by name, that sequences are made of, as `options` say.
base::Result<std::vector<std::string>> sequence_events(const ScenarioModel& loaded,
                                                       const ExploreOptions& options,
                                                       Context& context);

/// Simulates random sequences of events, each once, and records them in a run folder. The events
/// are those that the plan performs, with the plan's arguments, and the same (or, if asked for, all
/// of the model's) with other arguments where the action needs nothing of the plan. Every other
/// sequence begins with a part of one of `known`. `loaded` was loaded for closed loop. Reports what
/// claiming the folder and starting the simulator report.
base::Result<Explored> explore(const ScenarioModel& loaded, const std::vector<Evidence>& known,
                               const harness::SimulatorFactory& make_simulator,
                               const ExploreOptions& options, Context& context);

}  // namespace parallax::tools
