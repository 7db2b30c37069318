#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "compiler/base/result.h"
#include "harness/campaign/campaign.h"
#include "harness/campaign/sample_runner.h"
#include "tools/repair/repair.h"

namespace parallax::tools {

struct ExperimentOptions {
  /// Limit on simulations, counted with those made earlier; none: kRunsInModel where the world is a
  /// model, else kRunsInPhysics. 0: none are made.
  std::optional<std::int64_t> runs;
  std::int64_t jobs = 1;
  bool allow_commands = false;  // the scenario's simulator may be one
  std::function<base::Result<harness::SimulatorFactory>(const ScenarioModel&)> simulator;
  std::function<void(const harness::CampaignProgress&)> progress;
};
inline constexpr std::int64_t kRunsInModel = 60, kRunsInPhysics = 24;

/// Proposes repairs. Where several are as well founded as the first one, makes the simulation that
/// tells most of them apart, records it in RUN_DIR/experiments, and proposes again, until no two
/// can be told apart. Reports what propose_repairs and the simulator report.
base::Result<RepairResult> repair_with_experiments(const RepairOptions& options,
                                                   const ExperimentOptions& experiments,
                                                   Context& context);

}  // namespace parallax::tools
