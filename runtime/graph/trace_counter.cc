#include "runtime/graph/trace_counter.h"

#include <utility>
#include <variant>

#include "runtime/enumerate/model_enumerator.h"

namespace parallax::runtime {
namespace {

/// Up to so many traces blocking is quicker than finding every state.
constexpr int kOneByOne = 64;

bool is_stopped(const std::atomic<bool>* stop) { return stop != nullptr && stop->load(); }

}  // namespace

TraceCount count_traces(const compiler::CompiledModel& model, const GraphLimits& limits,
                        const std::atomic<bool>* stop) {
  TraceCount result;
  SolverSession session(model, make_cadical_solver(stop));
  ModelEnumerator enumerator(session);
  const auto finish = [&] {
    result.complete = enumerator.exhausted();
    result.solve_calls += session.solve_calls();
    return std::move(result);
  };
  for (int i = 0; i < kOneByOne; ++i) {
    if (!enumerator.next()) return finish();
    ++result.count;
  }
  auto split = split_into_windows(model);
  if (const auto* layered = std::get_if<LayeredModel>(&split)) {
    const auto graph = TraceGraph::build(*layered, limits, stop, result.remark);
    if (graph != nullptr) {
      result.count = graph->count();
      result.complete = true;
      result.strategy = "graph";
      result.states = graph->node_count();
      result.transitions = graph->edge_count();
      result.solve_calls = session.solve_calls() + graph->solve_calls();
      return result;
    }
  } else {
    result.remark = std::get<std::string>(split);
  }
  while (!is_stopped(stop) && enumerator.next()) ++result.count;
  return finish();
}

}  // namespace parallax::runtime
