#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "harness/campaign/campaign.h"
#include "harness/campaign/campaign_result.h"
#include "harness/campaign/journal.h"
#include "harness/campaign/trial.h"
#include "harness/config/scenario.h"

namespace parallax::harness {

// Shared parts of runs that simulate traces and of runs that execute a plan.

/// How many simulations a stream of samples may take, and how many the criterion asks for if all
/// are clean.
struct RunLimit {
  std::int64_t max_runs = 0;
  std::int64_t needed = 0;  // 0: it cannot tell
  std::int64_t most = 0;    // with those that count for no claim
};

/// `limits: max_runs`, or twice what the criterion needs and at least 300 where none is given: room
/// for a lost run, after which more are needed. `share`: of the error that the trace may spend.
RunLimit run_limit(const Scenario& scenario, double share = 1.0);

/// The folder of a run, and what it has on record.
struct ClaimedRun {
  RunFolder folder;
  JournalText recorded;
};
/// Claims the folder before anything is simulated, reads what is to be continued, and warns of a
/// limit that is too low. Reports what these steps report.
base::Result<ClaimedRun> claim_run(const Scenario& scenario, const CampaignOptions& options,
                                   base::SourceFiles& files, base::DiagnosticSink& sink);

/// Fills in what is known from the start.
void describe_run(const Scenario& scenario, const CampaignOptions& options,
                  const std::vector<GroundFluent>& fluents, CampaignResult& result);

/// Reports that the journal could not be written, if so.
base::Status check_written(const Journal& journal, const CampaignOptions& options,
                           base::DiagnosticSink& sink);

/// Compares a discrepancy with its repetition.
RepeatResult confirmation_of(const SampleRecord& record, const SampleRecord& again);

/// Records the time taken. Call it when no worker simulates any more.
void note_timing(const SimulatorBench& bench, std::chrono::steady_clock::time_point started,
                 CampaignResult& result);

/// Fills in the rate among `runs` that were seen to their end, and its interval (Clopper and
/// Pearson 1934) among these and `unseen` more, whose number is part of one that was fixed in
/// advance: its lower end takes all of the unseen for clean, its upper end all of them for
/// failures.
void set_interval(CauseRate& rate, std::int64_t runs, std::int64_t unseen, double confidence);

/// The same with an interval that holds whenever one looks, for a number of runs that may depend on
/// what was seen: mixture_upper of failures and of successes, each at half of the error.
void set_anytime_interval(CauseRate& rate, std::int64_t runs, std::int64_t unseen,
                          double confidence);

/// "15 runs were not seen to their end: the intervals allow for whatever they would have shown"
std::string unseen_text(std::int64_t unseen);

/// Counts a lost simulation.
void count_loss(const SampleRecord& record, TraceResult& result);

/// Caveats about losses that were repeated or are of the solver, and runs that strayed.
void add_loss_caveats(TraceResult& result);

/// Caveats about a simulator without seeds, and a discrepancy that could not be repeated (null:
/// there is none).
void add_simulator_caveats(const SimulatorInfo& simulator, const Discrepancy* found,
                           TraceResult& result);

}  // namespace parallax::harness
