#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "compiler/artifact/symbol_table.h"
#include "compiler/base/result.h"
#include "harness/campaign/campaign.h"
#include "harness/campaign/journal.h"
#include "harness/campaign/trial.h"
#include "tools/app/context.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {

/// A folder of further recordings within the folder of a run.
struct ExtraFolder {
  std::string run_dir, name;  // "out/plan2", "experiments"
  harness::JournalHeader header;
};

struct ExtraRunsOptions {
  std::int64_t jobs = 1;
  std::int64_t most = 0;  // limit, for progress
  std::function<void(const harness::CampaignProgress&)> progress;
};

/// Simulations besides those of a run, recorded in a folder of their own, in a journal like that of
/// the run, which stays unchanged.
class ExtraRuns {
 public:
  /// The scenario as it is run, and all else, outlives the object. Null if it was stopped. Reports
  /// what claiming the folder, reading its journal and starting the simulator report.
  static base::Result<std::unique_ptr<ExtraRuns>> open(
      const ExtraFolder& folder, const ScenarioModel& as_run,
      const harness::SimulatorFactory& make_simulator, const ExtraRunsOptions& options,
      Context& context);

  const harness::Scenario& scenario() const { return as_run_.scenario; }
  harness::SimulatorBench& bench() { return *bench_; }
  std::uint64_t seed() const { return header_.seed; }

  /// On record, with those of `make`.
  const std::map<std::int64_t, harness::TraceLine>& traces() const { return traces_; }
  /// The trace from the initial state of this number, as TraceLine has it. Null: not on record.
  const harness::TraceLine* find_line(std::int64_t trace, std::int64_t start_state) const;
  const std::map<harness::SampleKey, harness::SampleRecord>& samples() const { return samples_; }

  /// A trace in the ids of the scenario's model, which the bench judges by.
  harness::CampaignTrace in_symbols(const harness::CampaignTrace& trace) const;
  /// Its start with a sampler; reports as prepare_trace does.
  base::Result<harness::PreparedTrace> prepare_start(const harness::CampaignTrace& trace);

  /// The simulations to make: samples of one trace, or executions (without a line, as trace 1).
  struct Stream {
    const harness::TraceLine* line = nullptr;
    std::shared_ptr<const harness::SampleMaker> maker;
    /// The state in which the sample has to begin: one timepoint without events, by in_symbols.
    std::shared_ptr<const harness::CampaignTrace> start;
    /// Its starts were chosen: one that is not valid, or begins elsewhere, is no error.
    bool chosen = false;
    /// The trace from its first initial state, where `line` begins in another one.
    const harness::TraceLine* first = nullptr;
  };
  /// Makes those of the samples that are not on record. False if it was stopped, or the simulator
  /// was lost too often, which was reported. Reports starts and actions that the simulator does not
  /// take.
  base::Result<bool> make(const Stream& stream, std::int64_t first, std::int64_t last);
  /// The last report was that no draw was a valid start.
  bool rejected() const { return rejected_; }
  /// Writes the journal in order; nothing can be made afterwards.
  base::Status close();

 private:
  ExtraRuns(const ScenarioModel& as_run, const ExtraRunsOptions& options, Context& context)
      : as_run_(as_run),
        options_(options),
        context_(context),
        symbols_(std::make_shared<const compiler::SymbolTable>(as_run.compilation.model)) {}
  void announce(const harness::TraceLine& line);
  base::Result<bool> keep(harness::SampleRecord record, const Stream& stream);

  const ScenarioModel& as_run_;
  const ExtraRunsOptions& options_;
  Context& context_;
  std::shared_ptr<const compiler::SymbolTable> symbols_;
  harness::JournalHeader header_;
  std::unique_ptr<harness::Journal> journal_;
  std::map<std::int64_t, harness::TraceLine> traces_;
  std::map<harness::StartKey, harness::TraceLine> starts_;  // from other initial states
  std::map<harness::SampleKey, harness::SampleRecord> samples_;
  std::int64_t made_ = 0;
  bool rejected_ = false;
  std::unique_ptr<harness::SimulatorBench> bench_;  // last: its threads use the journal
};

}  // namespace parallax::tools
