#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "harness/campaign/campaign.h"
#include "harness/campaign/journal.h"
#include "harness/campaign/sample_runner.h"
#include "harness/campaign/worker_pool.h"
#include "harness/confidence/criterion.h"

namespace parallax::harness {

enum class TraceEnd : std::uint8_t {
  kDecided,  // the criterion says stop
  kDiscrepancy,
  kRunLimit,
  kLostTooOften,  // reported
  kStopped,       // by the stop flag
};

struct TraceOutcome {
  TraceEnd end = TraceEnd::kStopped;
  TraceResult result;
  std::optional<Discrepancy> discrepancy;
  std::vector<SampleRecord> consumed;  // in order of the sample index, repetitions after theirs
};

/// What all traces of a campaign share.
struct TraceContext {
  const Scenario& scenario;
  const CampaignOptions& options;
  const SimulatorInfo& simulator;
  const std::vector<GroundFluent>& fluents;
  const ConfidenceCriterion& criterion;
  std::int64_t max_runs;
  TraceFeed& feed;
  WorkerPool& pool;
  Journal& journal;
  std::int64_t& lost_in_a_row;  // goes on from trace to trace
  base::DiagnosticSink& sink;
};

/// Samples, simulates and judges one trace until the criterion, a discrepancy or a limit ends it.
base::Result<TraceOutcome> run_trace(const TraceContext& context,
                                     std::shared_ptr<const TracePlan> plan,
                                     const StartCuboid& start);

}  // namespace parallax::harness
