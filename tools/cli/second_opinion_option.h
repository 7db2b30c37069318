#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "harness/campaign/campaign.h"
#include "harness/campaign/second_opinion.h"
#include "tools/app/scenario_model.h"
#include "tools/cli/command.h"

namespace parallax::tools {

/// The second simulator that a run asks, and about how many clean simulations.
struct OpinionOptions {
  std::string other;  // an engine, or a command; empty: nobody
  std::int64_t clean = harness::kUsualOpinions;
};
void add_opinion_options(OptionTable& command, OpinionOptions& options);

/// The second opinion of one run. Everything that it is given outlives it.
class OpinionOfRun {
 public:
  /// Null if no second simulator is asked for. Reports kUsage for an engine that cannot simulate
  /// the scenario's world, or does so already.
  static base::Result<std::unique_ptr<OpinionOfRun>> of(const OpinionOptions& options,
                                                        const ScenarioModel& loaded,
                                                        Invocation& invocation);

  /// Records the result of each simulation, and passes it on.
  harness::SampleListener listener(harness::SampleListener next);
  /// Starts the other simulator before the run, so that its errors are reported before hours of
  /// work. False when stopped. Reports what a run reports of its simulator.
  base::Result<bool> start(const runtime::Symbols& symbols,
                           const harness::CampaignOptions& campaign);
  /// Asks the other simulator, and adds its answers to the result. An unfinished run asks nothing.
  base::Status ask(harness::TraceFeed& feed, harness::CampaignResult& result);
  base::Status ask_about_executions(harness::CampaignResult& result);

 private:
  OpinionOfRun(const OpinionOptions& options, const ScenarioModel& loaded, Invocation& invocation)
      : options_(options),
        loaded_(loaded),
        other_{loaded.scenario, {}, {}, loaded.scenario_hash},
        invocation_(invocation) {}
  base::Status choose_engine(harness::EngineKind engine);
  base::Status choose_command();
  using Asked = base::Result<std::optional<std::vector<harness::Opinion>>>;
  template <typename Ask>
  base::Status ask_with(harness::CampaignResult& result, const Ask& ask);

  const OpinionOptions& options_;
  const ScenarioModel& loaded_;
  ScenarioModel other_;  // the scenario with the other simulator; without a model
  Invocation& invocation_;
  std::vector<harness::SampleRow> rows_;
  harness::SimulatorFactory make_;
  std::filesystem::path run_dir_;
  std::uint64_t seed_ = 0;
  std::unique_ptr<harness::SimulatorBench> bench_;
};

}  // namespace parallax::tools
