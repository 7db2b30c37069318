#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "compiler/base/result.h"
#include "harness/campaign/loop_stream.h"
#include "tools/app/closed_loop.h"
#include "tools/app/extra_runs.h"
#include "tools/repair/experiment.h"

namespace parallax::tools {

/// Makes experiments in the scenario's simulator, some simulations of each at once (a batch). In
/// open loop each is a trace of the journal; in closed loop an execution that begins in the
/// experiment's state, with numbers that follow those of the run.
class ExperimentRuns {
 public:
  /// Everything outlives the object; `last_sample`: of the run. Null if it was stopped. Reports as
  /// ExtraRuns and ClosedLoop do.
  static base::Result<std::unique_ptr<ExperimentRuns>> open(
      const ExtraFolder& folder, const ScenarioModel& as_run, std::int64_t last_sample,
      const harness::SimulatorFactory& make_simulator, const ExtraRunsOptions& options,
      Context& context);

  /// Simulations on record.
  std::int64_t made() const { return static_cast<std::int64_t>(runs_->samples().size()); }
  /// May it be repeated? Not after the maximum number of samples, or if the simulator cannot begin
  /// there.
  bool usable(const harness::CampaignTrace& trace) const;

  /// Completes a batch that was ended early, within the budget. False as of ExtraRuns::make.
  base::Result<bool> complete(std::int64_t budget);
  /// Makes a batch of it, within the budget. Also false if it turned out that the simulator cannot
  /// begin there, which `usable` then takes into account.
  base::Result<bool> make(const Experiment& experiment, std::int64_t budget);
  base::Status close() { return runs_->close(); }

 private:
  ExperimentRuns(const ScenarioModel& as_run, std::int64_t last_sample, Context& context)
      : as_run_(as_run), last_sample_(last_sample), context_(context) {}

  base::Result<bool> prepare_loop();
  base::Result<bool> batch(const harness::TraceLine& line, std::int64_t budget);
  base::Result<bool> batch_from(std::int64_t start, std::int64_t budget);
  std::int64_t samples_of(std::int64_t trace) const;
  std::optional<std::int64_t> state_of(const harness::CampaignTrace& trace) const;
  std::int64_t batch_size() const { return as_run_.world != nullptr ? 1 : 4; }

  const ScenarioModel& as_run_;
  std::int64_t last_sample_;
  Context& context_;
  std::unique_ptr<ExtraRuns> runs_;
  std::set<std::string> no_start_;  // keys of traces
  std::unique_ptr<ClosedLoop> loop_;
  std::unique_ptr<harness::LoopStream> stream_;
};

}  // namespace parallax::tools
