#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "harness/confidence/paired_runs.h"
#include "harness/confidence/rate_evidence.h"
#include "harness/config/gate_rules.h"
#include "tools/diff/rates_revision.h"

namespace parallax::tools {

/// The rates of the trace with these events; null: there are none.
const RevisionRates* rates_for(const RatesRevision& in, const std::string& events);

/// How often a cause was seen in a trace.
std::int64_t times(const RevisionRates& trace, const std::string& cause);

/// "20 of 100 before, 25 of 99 (1 lost) now"
std::string change_text(const harness::RateCounts& before, const harness::RateCounts& after);

/// Why the two cannot be compared; empty: they can.
std::string not_comparable(const RatesRevision& before, const RatesRevision& after);

/// Has a probability grown?
struct GrowthEvidence {
  bool grew = false;   // with the confidence that was asked for
  double order = 0.0;  // the lower, the surer
  std::string words;
};

/// The error that a rule may spend, and the number of tests that share it.
struct SharedError {
  double error = 0.05;
  std::size_t tests = 1;

  double of_one() const { return error / static_cast<double>(tests); }
};

/// Fisher's exact test; anytime-valid bounds where a number of runs depends on its results.
GrowthEvidence weigh_growth(const harness::RateCounts& before, const harness::RateCounts& after,
                            const SharedError& shared);

/// One trace before and after.
struct RateChange {
  harness::RateCounts before, after;
  /// Run by run, where both sides list as many runs of one seed and not all starts differ. That
  /// does not depend on how the runs ended.
  std::optional<harness::PairedRuns> pairs;
  std::int64_t equal_starts = 0;
};

RateChange change_of(const RatesRevision& before, const RatesRevision& after,
                     const RevisionRates& old, const RevisionRates& now);

/// "20 of 100 before, 25 now; of 100 pairs, 98 with equal starts, 6 fail anew and 1 no longer"
std::string change_text(const RateChange& change);

enum class RuleOutcome : std::uint8_t { kKept, kBroken, kUndecided };

/// Judges the change of one trace.
RuleOutcome weigh_change(const RateChange& change, const harness::GateRules::Worse& worse,
                         const SharedError& shared, std::string& words);

}  // namespace parallax::tools
