#pragma once

#include <cstdint>
#include <vector>

#include "runtime/graph/trace_counter.h"

namespace parallax::runtime {

struct TraceSample {
  /// Numbered 1 .. size as drawn; each was any of `population` traces with equal probability,
  /// whatever the others. Empty if there is no trace or the search was stopped.
  std::vector<Trace> traces;
  mpz_class population;
  bool complete = false;  // else stopped
  SourceStats stats;
  std::string refusal;  // as of TraceCount
};

/// Draws `size` traces uniformly, with replacement. The same seed draws the same traces whatever
/// the strategy. With the graph each costs one walk; without it all traces are found twice.
TraceSample sample_traces(const CompiledModel& model, const TraceQuery& query, std::size_t size,
                          std::uint64_t seed);

}  // namespace parallax::runtime
