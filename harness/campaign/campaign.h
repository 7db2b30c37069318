#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "compiler/base/diagnostic.h"
#include "harness/campaign/campaign_result.h"
#include "harness/campaign/trace_input.h"
#include "harness/config/scenario.h"
#include "harness/simulator/simulator.h"

namespace parallax::harness {

/// Makes the simulator of one worker. Called in the worker's thread, at most once a worker.
using SimulatorFactory = std::function<std::unique_ptr<Simulator>()>;

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
  std::filesystem::path run_dir;  // made if missing; holds journal.ndjson
  std::string scenario_hash;      // over every text that was read (hash_of_sources)
  std::string tool_version;
  const std::atomic<bool>* stop = nullptr;                // raised by SIGINT and SIGTERM
  std::function<void(const CampaignProgress&)> progress;  // called in the caller's thread
};

/// The loop: trace, sample, simulate, compare, decide, next trace. Results are consumed in order
/// of the sample index, so nothing that is returned or left on disk depends on `jobs`, except what
/// was under way when `stop` was raised. A discrepancy is repeated once with the same draw before
/// it is accepted.
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

/// A stable hash over the texts of all files read so far, in order of loading; names do not count.
std::string hash_of_sources(const base::SourceFiles& files);

}  // namespace parallax::harness
