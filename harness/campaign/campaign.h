#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "compiler/base/diagnostic.h"
#include "harness/campaign/campaign_result.h"
#include "harness/campaign/run_recorder.h"
#include "harness/campaign/sample_row.h"
#include "harness/campaign/sample_runner.h"
#include "harness/campaign/trace_input.h"
#include "harness/config/scenario.h"

namespace parallax::harness {

struct CampaignProgress {
  std::int64_t trace = 0;
  std::int64_t done = 0;    // samples consumed for this trace
  std::int64_t needed = 0;  // as far as the criterion can tell; else the run limit
  double runs_per_s = 0.0;
};

struct CampaignOptions {
  std::uint64_t seed = 1;
  std::int64_t jobs = 1;
  bool keep_going = false;  // do not stop at the first discrepancy
  bool resume = false;
  /// How the traces were enumerated that it is handed: for the record.
  bool all_hits = false, split_initial = false;
  bool random_sequences = false;  // they are of events, not of traces of the model
  std::filesystem::path run_dir;  // made if missing; holds journal.ndjson
  std::string start_folder;       // where the paths of the scenario start; empty: not recorded
  std::string scenario_hash;      // over every text that was read (hash_of_sources)
  std::string tool_version;
  /// Digits that tell machines and builds apart, for the record; empty: not known.
  std::string arithmetic, build;
  bool mixed = false;  // workers may be of several kinds, and simulations name theirs
  RecordMode record = RecordMode::kNone;
  const std::atomic<bool>* stop = nullptr;                // raised by SIGINT and SIGTERM
  std::function<void(const CampaignProgress&)> progress;  // called in the caller's thread
  SampleListener on_sample;  // those that are on record already, too; none: nobody listens
};

/// The loop:
///
///     for each trace of the model and the plan, shortest first:
///       trial = its start region, a sampler over it, and the calls for its events
///       with `search`: try starts that a strategy proposes, by how near earlier ones came to a
///         discrepancy (search_phase.h); leave the trace with the first one
///       until the criterion is satisfied or `max_runs` simulations were made:
///         draw a start, simulate the events from it, observe at every timepoint
///         start not valid:      draw again; end with an error after `max_rejected_starts`
///         other initial state:  end with an error
///         simulator lost:       count a failure; end after `max_lost_in_a_row`
///         every state predicted, or admitted by the model:  count a clean run
///         else:                 repeat it once, report a discrepancy, leave the trace
///       verdict of the trace
///       after a discrepancy: end, unless `keep_going`
///     rewrite the journal in order, give the verdict over all traces
///
/// Trial (trial.h) is what stands between a trace and its judged samples; TraceCampaign adds the
/// stop rule. Results are consumed in order of the sample index, so nothing that is returned or
/// left on disk depends on `jobs`, except what was under way when `stop` was raised. Each finished
/// simulation is in the journal before it counts, and one that is on record is not made again.
///
/// Fails, having reported, for a run folder in use, a journal of another run, a simulator that
/// does not know a variable or a controller (input), starts that are always invalid (input) and an
/// initial observation that does not map back to the trace's initial state (internal). Where that
/// happens after finished traces, they are returned, marked as failed. A simulator
/// that is lost too often is reported too, but gives a result, with the verdict kInconclusive.
base::Result<CampaignResult> run_campaign(const Scenario& scenario, TraceFeed& traces,
                                          const SimulatorFactory& make_simulator,
                                          const CampaignOptions& options, base::SourceFiles& files,
                                          base::DiagnosticSink& sink);

class LoopFeed;

/// The same for a plan that is executed: one stream of samples, each an execution of the plan from
/// any of the model's initial states (LoopSamples), compared with all executions of the model
/// (judge_path). It ends with the criterion, the first discrepancy, or the first execution that a
/// limit ended, as nothing can be said of its continuation. Also reports kLoopStates and its
/// neighbours, before anything is simulated, and ends of executions that are errors.
base::Result<CampaignResult> run_loop_campaign(const Scenario& scenario, LoopFeed& feed,
                                               const SimulatorFactory& make_simulator,
                                               const CampaignOptions& options,
                                               base::SourceFiles& files,
                                               base::DiagnosticSink& sink);

/// Reports kRunLimitTooLow, and says so, where the criterion can never be met, at the scenario's
/// number unless another one took its place. `share`: of the error that a trace may spend.
bool warn_of_low_limit(const Scenario& scenario, const base::SourceFiles& files,
                       base::DiagnosticSink& sink, double share = 1.0);

/// A stable hash over the texts of the files read so far, from the one of number `first` on, in
/// order of loading; names do not count.
std::string hash_of_sources(const base::SourceFiles& files, std::size_t first = 0);

}  // namespace parallax::harness
