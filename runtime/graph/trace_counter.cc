#include "runtime/graph/trace_counter.h"

#include <utility>

namespace parallax::runtime {

TraceCount count_traces(const CompiledModel& model, const TraceQuery& query) {
  TraceCount result;
  ModelTraces traces(model, query);
  if (traces.graph() == nullptr && !traces.refusal().empty()) {
    result.refusal = traces.refusal();
    return result;
  }
  const auto stopped = [&] { return query.stop != nullptr && query.stop->load(); };
  while (true) {
    if (const auto* graph = traces.graph()) {
      result.count = graph->count();
      result.complete = true;
      result.stats = traces.stats();
      return result;
    }
    if (stopped() || !traces.next()) break;
    ++result.count;
  }
  result.complete = traces.exhausted();
  result.stats = traces.stats();
  return result;
}

}  // namespace parallax::runtime
