#pragma once

#include <gmpxx.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "runtime/graph/layered_model.h"
#include "runtime/graph/window_solver.h"

namespace parallax::runtime {

/// A state of the graph: the observed values, and every valuation of the hidden slots that some
/// trace with the same observations so far can have (subset construction, Rabin and Scott 1959).
struct GraphNode {
  Bits observed;
  std::vector<Bits> hidden;  // ascending
  friend bool operator==(const GraphNode&, const GraphNode&) = default;
};
struct GraphNodeHash {
  std::size_t operator()(const GraphNode& node) const;
};

struct GraphEdge {
  std::uint32_t events = 0;  // index into TraceGraph::event_sets
  std::uint32_t target = 0;  // index into TraceGraph::nodes
};

struct GraphLimits {
  std::size_t nodes = 2'000'000;  // of all layers together
  /// Ways on from a state, each counted once for every valuation of the hidden slots.
  std::size_t edges = 20'000'000;
  std::int64_t conflicts = std::numeric_limits<std::int64_t>::max();  // of the search for them
  bool solver = true;  // states that a search does not settle are given to one
  /// The lesser of each.
  GraphLimits within(const GraphLimits& other) const {
    return {std::min(nodes, other.nodes), std::min(edges, other.edges),
            std::min(conflicts, other.conflicts), solver && other.solver};
  }
};

class StateOrbits;
struct GraphOrbits;

/// The traces of a model as the paths of a layered graph: every distinct state of a window is asked
/// for its successors once, whatever leads to it and whenever, so that cost grows with states and
/// not with traces. A path from the start to the last layer is a trace, and distinct paths are
/// distinct traces, provided that clauses which no window has can hold
/// (LayeredModel::has_unplaced).
class TraceGraph {
 public:
  /// None if the solver was stopped or a limit was hit; `reason` says which. `model` outlives the
  /// graph, `stop` may be null. With `orbits` a state stands for all of its orbit: the graph counts
  /// as without, but its paths are no longer the traces. `work`, if given, receives the cost
  /// (WindowSolver::work), also where there is no graph.
  static std::unique_ptr<TraceGraph> build(const LayeredModel& model, const GraphLimits& limits,
                                           const std::atomic<bool>* stop, std::string& reason,
                                           const GraphOrbits* orbits = nullptr,
                                           std::int64_t* work = nullptr);

  /// The reason where a state needs a solver and the limits say that it has none.
  static constexpr std::string_view kWantsSolver = "a state has too many choices for a search";

  /// The exact number of traces.
  const mpz_class& count() const { return total_; }
  /// Paths from a node of the layer of timepoint t to the last layer.
  const mpz_class& completions(Timepoint t, std::uint32_t node) const;

  const LayeredModel& model() const { return model_; }
  const GraphNode& node(std::uint32_t index) const { return *nodes_[index]; }
  const Bits& events(std::uint32_t index) const { return *event_sets_[index]; }
  /// The nodes at timepoint 0 in canonical order; with orbits one for each state there.
  const std::vector<std::uint32_t>& starts() const { return starts_; }
  /// The ways on from a node, in canonical order; some may lead to no trace.
  const std::vector<GraphEdge>& edges(Timepoint t, std::uint32_t node) const;
  /// Every node fixes its hidden slots.
  bool is_determined() const { return determined_; }

  std::size_t node_count() const { return nodes_.size(); }
  std::size_t edge_count() const { return edge_count_; }
  std::int64_t solve_calls() const;
  /// The cost of building the graph, as WindowSolver::work.
  std::int64_t work() const;

 private:
  TraceGraph(const LayeredModel& model, const GraphLimits& limits, const std::atomic<bool>* stop,
             const GraphOrbits* orbits);
  bool expand(std::string& reason);
  bool expand_node(std::uint32_t step, std::uint32_t node, std::string& reason);
  std::optional<std::vector<Move>> moves(WindowSolver& window, std::span<const Literal> state,
                                         std::size_t limit);
  bool give_up(std::string& reason) const;
  void count_back();
  std::uint32_t intern(GraphNode node, const StateOrbits* orbits);
  std::uint32_t intern_events(Bits events);

  using Counts = std::unordered_map<std::uint32_t, mpz_class>;  // by node, for look-up only

  const LayeredModel& model_;
  GraphLimits limits_;
  const std::atomic<bool>* stop_;
  const GraphOrbits* orbits_;    // while it is built; null: every state for itself
  std::vector<Literal> before_;  // LayeredModel::state_before
  WindowSolver start_;
  std::vector<WindowSolver> steps_;
  // For look-up only; the numbers follow the order in which nodes and events were met.
  std::unordered_map<GraphNode, std::uint32_t, GraphNodeHash> node_index_;
  std::vector<const GraphNode*> nodes_;
  std::unordered_map<Bits, std::uint32_t> event_index_;
  std::vector<const Bits*> event_sets_;
  std::vector<std::unordered_map<std::uint32_t, std::vector<GraphEdge>>> edges_;  // by step, node
  std::vector<std::vector<std::uint32_t>> layers_;                                // by timepoint
  std::vector<Counts> completions_;                                               // by timepoint
  std::vector<std::uint32_t> starts_;
  std::size_t edge_count_ = 0;
  std::size_t move_count_ = 0;  // as edges, for each hidden valuation
  bool needs_solver_ = false;   // and the limits allow none
  bool determined_ = true;
  mpz_class total_;
};

}  // namespace parallax::runtime
