#pragma once

#include <gmpxx.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/base/word_table.h"
#include "runtime/enumerate/model_enumerator.h"
#include "runtime/graph/component_traces.h"
#include "runtime/graph/graph_paths.h"
#include "runtime/graph/trace_graph.h"
#include "runtime/session/solver_session.h"

namespace parallax::runtime {

enum class Strategy : std::uint8_t {
  kAuto,        // the one that suits the model and the number of traces
  kSearch,      // propagation and backtracking, no solver
  kBlocking,    // one clause for each trace
  kGuarded,     // clauses that are retired with the first half of the horizon
  kTree,        // assumed prefixes, clauses that are retired with them
  kGraph,       // the paths of the layered graph
  kComponents,  // counted by components, each trace found by its number
};

inline constexpr auto kStrategyNames = base::word_table<Strategy>(
    "auto", "search", "blocking", "guarded", "tree", "graph", "components");

struct TraceQuery {
  Distinct distinct = Distinct::kObservable;
  Strategy strategy = Strategy::kAuto;
  TraceOrder order = TraceOrder::kCanonical;  // order of traces that a solver finds one by one
  std::int64_t wanted = 0;                    // number of traces that will be asked for; 0: all
  /// The first trace may be sought among representatives of orbits, where a search does not find it
  /// and no strategy is forced: the absence of traces is then reported with `by_symmetry`.
  bool breaks_symmetry = true;
  /// Only the number is wanted: ModelTraces::next() also returns nothing after each attempt at a
  /// graph, so that the caller can use the graph, or count in another way before the next one.
  bool number_only = false;
  GraphLimits limits = {};
  /// Literals that the search for all traces sets, besides two passes over the whole model, before
  /// a graph is tried: a few milliseconds.
  std::int64_t search_first = 20'000;
  /// Threads for a question that is hard for a solver (CubeOptions::jobs); 0: it is not cut.
  std::int64_t jobs = 0;
  const std::atomic<bool>* stop = nullptr;
};

/// From this many traces ahead on, a trace is not sought by listing those before it.
inline constexpr std::int64_t kFar = 64;
/// Search finds transitions some hundred times faster than a solver finds traces in order. So a
/// graph that stays small is tried first, and larger ones as traces come.
inline constexpr GraphLimits kSmallGraph = {500'000, 50'000, 10'000};
inline constexpr GraphLimits kMediumGraph = {2'000'000, 500'000, 200'000};

/// The layered graph of a model, or why it has none.
struct ModelGraph {
  std::unique_ptr<LayeredModel> layered;  // none: no graph of any size
  std::unique_ptr<TraceGraph> graph;
  std::string reason;
};

/// The traces of a model without constraints at its full horizon, by the strategy that is asked for
/// or the one that suits.
class ModelTraces final : public TraceSource {
 public:
  /// `model` outlives the traces.
  ModelTraces(const CompiledModel& model, TraceQuery query);
  std::optional<Trace> next() override;
  bool print_next(const TraceFormat& format, std::string& out) override;
  bool exhausted() const override { return source_->exhausted(); }
  void look_on() override;
  SourceStats stats() const override;
  /// Why the strategy that was asked for cannot be had; empty: it can.
  const std::string& refusal() const { return refusal_; }
  /// The graph, once there is one; it may count traces that it cannot list.
  const TraceGraph* graph() const { return graph_.graph.get(); }
  /// Graphs that are still to be tried, larger ones later.
  std::size_t graphs_left() const { return attempts_.size(); }
  /// Makes the trace that `before` others precede the next one; it must not lie before the present
  /// next one. At once where there is a graph or the number of traces is known by components, else
  /// by finding the traces before it.
  void seek(const mpz_class& before);

 private:
  /// An attempt at a graph: due once a solver has given `given` traces, or once the search has cost
  /// as much as the last attempt.
  struct Attempt {
    std::int64_t given;
    GraphLimits limits;
  };

  SolverSession& session();
  void use_blocking();
  bool may_break_symmetry() const {
    return query_.breaks_symmetry && query_.strategy == Strategy::kAuto;
  }
  void break_symmetry();
  /// Is there any trace?
  SolveStatus has_trace();
  void use_search(std::int64_t conflicts);
  void use_graph(const GraphLimits& limits);
  bool use_components(ComponentEffort effort);
  void attempt_graph();
  void leave_search();
  /// Replaces a search that has stopped short by a better source. False: it has not stopped short.
  bool change_source();
  bool is_due() const {
    return search_ == nullptr && !attempts_.empty() && attempts_.back().given <= given_;
  }
  /// Has the graph not been tried yet, or was it too large only?
  bool can_grow() const { return !is_tried_ || (graph_.layered && !graph_.graph); }
  void use_tree();

  const CompiledModel& model_;
  TraceQuery query_;
  std::vector<Attempt> attempts_;  // attempts still to be made; the last one first
  std::optional<SolverSession> session_, tree_session_;
  std::optional<SymmetryBreaker> breaker_;  // of `session_`, while no trace was found
  ModelGraph graph_;
  std::unique_ptr<TraceSource> source_;
  GraphPaths* paths_ = nullptr;            // `source_`, if it is the graph
  SearchTraces* search_ = nullptr;         // `source_`, if it is a search
  ComponentTraces* components_ = nullptr;  // `source_`, if it is that
  std::int64_t given_ = 0;
  bool is_tried_ = false;        // there was an attempt at the graph
  std::int64_t graph_work_ = 0;  // cost of the last one, as TraceGraph::work
  std::string refusal_;
  std::string remark_;  // why the graph was not used
};

}  // namespace parallax::runtime
