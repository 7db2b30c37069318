#pragma once

#include <gmpxx.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "runtime/graph/model_traces.h"

namespace parallax::runtime {

struct TraceCount {
  mpz_class count;
  bool complete = false;  // else at least so many
  SourceStats stats;
  std::string refusal;  // why the strategy that was asked for cannot be had; nothing was counted
};

/// Counts the traces of a model without constraints at its full horizon. Left to choose, a few are
/// found one by one; if there are more, the graph counts them, also one that has of states which
/// symmetries make of each other one only, and where the model has none, they are counted by
/// components, or else one by one.
TraceCount count_traces(const CompiledModel& model, const TraceQuery& query);

struct DrawnTraces {
  /// Numbered 1 .. size as drawn; each was any of `population` traces with equal probability,
  /// whatever the others. Empty if there is no trace or the search was stopped.
  std::vector<Trace> traces;
  mpz_class population;
  bool complete = false;  // else stopped
  SourceStats stats;
  std::string refusal;  // as of TraceCount
};

/// Draws `size` traces uniformly, with replacement. The same seed draws the same traces whatever
/// the strategy. With the graph each costs one walk, by components some counts; without both all
/// traces are found twice.
DrawnTraces sample_traces(const CompiledModel& model, const TraceQuery& query, std::size_t size,
                          std::uint64_t seed);

}  // namespace parallax::runtime
