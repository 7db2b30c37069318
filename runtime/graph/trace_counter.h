#pragma once

#include <gmpxx.h>

#include "runtime/graph/model_traces.h"

namespace parallax::runtime {

struct TraceCount {
  mpz_class count;
  bool complete = false;  // else at least so many
  SourceStats stats;
  std::string refusal;  // why the strategy that was asked for cannot be had; nothing was counted
};

/// Counts the traces of a model without constraints at its full horizon. Left to choose, a few are
/// found one by one; if there are more, the graph counts them, and where the model has none, the
/// tree does.
TraceCount count_traces(const CompiledModel& model, const TraceQuery& query);

}  // namespace parallax::runtime
