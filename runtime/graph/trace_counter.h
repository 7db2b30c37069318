#pragma once

#include <gmpxx.h>

#include <atomic>
#include <cstdint>
#include <string>

#include "compiler/artifact/compiled_model.h"
#include "runtime/graph/trace_graph.h"

namespace parallax::runtime {

struct TraceCount {
  mpz_class count;        // distinct over HoldsAt and Happens
  bool complete = false;  // else at least so many
  /// "blocking": one clause for each trace; "graph": the layered graph.
  std::string strategy = "blocking";
  std::string remark;                       // why the graph was not used, if it would have paid
  std::size_t states = 0, transitions = 0;  // of the graph
  std::int64_t solve_calls = 0;
};

/// Counts the traces of a model without constraints at its full horizon. A few are found one by
/// one; if there are more, the graph counts them, and where the model has none, blocking goes on.
TraceCount count_traces(const compiler::CompiledModel& model, const GraphLimits& limits,
                        const std::atomic<bool>* stop);

}  // namespace parallax::runtime
