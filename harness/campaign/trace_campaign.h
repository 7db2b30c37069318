#pragma once

#include <optional>
#include <vector>

#include "harness/campaign/campaign.h"
#include "harness/campaign/journal.h"
#include "harness/campaign/trace_family.h"
#include "harness/campaign/trial.h"
#include "harness/confidence/criterion.h"

namespace parallax::harness {

enum class TraceEnd : std::uint8_t {
  kDecided,  // the criterion says stop
  kDiscrepancy,
  kRunLimit,
  kRanOut,        // hardly any candidate is an initial state of the trace
  kLostTooOften,  // reported
  kStopped,       // by the stop flag
};

struct TraceOutcome {
  TraceEnd end = TraceEnd::kStopped;
  TraceResult result;
  std::optional<Discrepancy> discrepancy;
  std::vector<SampleRecord> consumed;  // in order of the sample index, repetitions after theirs
  std::optional<CleanSample> first_clean;
};

/// The data that all traces of a campaign share.
struct TraceContext {
  const Scenario& scenario;
  const CampaignOptions& options;
  TraceFamily& family;
  TrialBench& bench;
  const Journal& journal;
  RunRecorder& recorder;
  const base::SourceFiles& files;
  base::DiagnosticSink& sink;
};

/// Takes samples of one trace until the criterion, a discrepancy or a limit ends it.
base::Result<TraceOutcome> run_trace(const TraceContext& context, Trial trial);

}  // namespace parallax::harness
