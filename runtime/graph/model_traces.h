#pragma once

#include <gmpxx.h>

#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "runtime/enumerate/model_enumerator.h"
#include "runtime/graph/graph_paths.h"
#include "runtime/graph/trace_graph.h"

namespace parallax::runtime {

enum class Strategy : std::uint8_t {
  kAuto,      // a few by blocking, then the graph, or else the tree
  kBlocking,  // one clause for each trace
  kGuarded,   // clauses that are retired with the first half of the horizon
  kTree,      // assumed prefixes, clauses that are retired with them
  kGraph,     // the paths of the layered graph
};

inline constexpr std::array<std::pair<Strategy, std::string_view>, 5> kStrategyNames = {{
    {Strategy::kAuto, "auto"},
    {Strategy::kBlocking, "blocking"},
    {Strategy::kGuarded, "guarded"},
    {Strategy::kTree, "tree"},
    {Strategy::kGraph, "graph"},
}};

struct TraceQuery {
  Distinct distinct = Distinct::kObservable;
  Strategy strategy = Strategy::kAuto;
  std::int64_t wanted = 0;  // so many traces will be asked for; 0: all
  GraphLimits limits = {};
  const std::atomic<bool>* stop = nullptr;
};

/// The layered graph of a model, or why it has none.
struct ModelGraph {
  std::unique_ptr<LayeredModel> layered;
  std::unique_ptr<TraceGraph> graph;
  std::string reason;
};
ModelGraph build_graph(const CompiledModel& model, const TraceQuery& query);

/// The traces of a model without constraints at its full horizon, by the strategy that is asked for
/// or the one that suits.
class ModelTraces final : public TraceSource {
 public:
  /// `model` outlives the traces.
  ModelTraces(const CompiledModel& model, TraceQuery query);
  std::optional<Trace> next() override;
  bool print_next(const TraceFormat& format, std::string& out) override;
  bool exhausted() const override { return source_->exhausted(); }
  SourceStats stats() const override;
  /// Why the strategy that was asked for cannot be had; empty: it can.
  const std::string& refusal() const { return refusal_; }
  /// The graph, once there is one; it may count traces that it cannot list.
  const TraceGraph* graph() const { return graph_.graph.get(); }
  /// The next trace becomes the one that `before` others precede, which is not before the one that
  /// is next. At once where there is a graph, else by finding what comes before.
  void seek(const mpz_class& before);

 private:
  void use_graph();
  void leave_blocking();

  const CompiledModel& model_;
  TraceQuery query_;
  SolverSession session_;
  std::optional<SolverSession> tree_session_;
  ModelGraph graph_;
  std::unique_ptr<TraceSource> source_;
  GraphPaths* paths_ = nullptr;  // `source_`, if it is the graph
  std::int64_t given_ = 0;
  bool is_final_ = true;  // `source_` stays to the end
  std::string refusal_;
  std::string remark_;  // why the graph was not used
};

}  // namespace parallax::runtime
