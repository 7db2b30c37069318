// The traces of a model as the paths of a layered graph, so that cost grows with states and not
// with traces.
//
// A window of clauses ties the state before a step to the events and the state after it
// (layered_model.cc). A node is an observed state with all valuations of the hidden slots that
// some trace with the same observations can have (subset construction, Rabin and Scott 1959), so
// different paths are different traces. Each node is expanded once for each distinct window,
// whenever it is reached; its window lists the ways on (window_solver.cc). From the last layer
// backwards each node gets the exact number of its completions, whose sum over the starts is the
// number of traces.
//
// Cost: one enumeration for each node, window and hidden valuation; one addition of big numbers
// for each edge of each layer. Nodes, edges and conflicts are limited.

#include "runtime/graph/trace_graph.h"

#include <algorithm>
#include <functional>
#include <map>
#include <utility>

#include "runtime/graph/state_orbits.h"

namespace parallax::runtime {
namespace {

/// Literals for the events of a step and the state after it.
std::vector<Literal> events_and_state(const LayeredModel& model) {
  std::vector<Literal> out;
  for (const auto slot : model.events) out.push_back(model.after(slot));
  const auto state = model.state_after();
  out.insert(out.end(), state.begin(), state.end());
  return out;
}

/// Each once.
void sort_out(std::vector<std::uint32_t>& nodes) {
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
}

}  // namespace

TraceGraph::TraceGraph(const LayeredModel& model, const GraphLimits& limits,
                       const std::atomic<bool>* stop, const GraphOrbits* orbits)
    : model_(model),
      limits_(limits),
      stop_(stop),
      orbits_(orbits),
      before_(model.state_before()),
      start_(model.start, before_, stop) {
  const auto projection = events_and_state(model);
  for (const auto& step : model.steps) steps_.emplace_back(step, projection, stop);
  edges_.resize(model.steps.size());
}

std::unique_ptr<TraceGraph> TraceGraph::build(const LayeredModel& model, const GraphLimits& limits,
                                              const std::atomic<bool>* stop, std::string& reason,
                                              const GraphOrbits* orbits, std::int64_t* work) {
  auto graph = std::unique_ptr<TraceGraph>(new TraceGraph(model, limits, stop, orbits));
  const bool is_whole = graph->expand(reason);
  if (work != nullptr) *work = graph->work();
  if (!is_whole) return nullptr;
  graph->orbits_ = nullptr;
  graph->count_back();
  return graph;
}

std::size_t GraphNodeHash::operator()(const GraphNode& node) const {
  const std::hash<Bits> of_bits;
  auto hash = of_bits(node.observed);
  for (const auto& hidden : node.hidden) hash = hash * 0x9E3779B97F4A7C15U + of_bits(hidden);
  return hash;
}

std::uint32_t TraceGraph::intern(GraphNode node, const StateOrbits* orbits) {
  if (node.hidden.size() > 1) determined_ = false;
  if (orbits != nullptr) orbits->represent(node);
  const auto [entry, added] =
      node_index_.try_emplace(std::move(node), static_cast<std::uint32_t>(nodes_.size()));
  if (added) nodes_.push_back(&entry->first);
  return entry->second;
}

std::uint32_t TraceGraph::intern_events(Bits events) {
  const auto [entry, added] =
      event_index_.try_emplace(std::move(events), static_cast<std::uint32_t>(event_sets_.size()));
  if (added) event_sets_.push_back(&entry->first);
  return entry->second;
}

/// All ways on, in canonical order. None: stopped, or a limit was hit.
std::optional<std::vector<Move>> TraceGraph::moves(WindowSolver& window,
                                                   std::span<const Literal> state,
                                                   std::size_t limit) {
  const auto answer = window.ask(state, {limit, limits_.conflicts, limits_.solver});
  needs_solver_ = needs_solver_ || answer.end == WindowEnd::kNeedsSolver;
  if (!answer.is_complete()) return std::nullopt;
  std::vector<Move> out;
  out.reserve(answer.found.size());
  for (const auto& values : answer.found) out.push_back(move_of(model_, values));
  return out;
}

bool TraceGraph::expand(std::string& reason) {
  auto starts_found = moves(start_, {}, std::min(limits_.nodes, limits_.edges));
  if (!starts_found) return give_up(reason);
  const auto* orbits = orbits_ == nullptr ? nullptr : &orbits_->at_start;
  std::map<Bits, std::vector<Bits>> starts;
  for (auto& move : *starts_found) starts[move.observed].push_back(std::move(move.hidden));
  for (auto& [observed, hidden] : starts) {
    std::sort(hidden.begin(), hidden.end());
    starts_.push_back(intern({observed, std::move(hidden)}, orbits));
  }
  layers_.push_back(starts_);
  sort_out(layers_.back());
  std::size_t total = starts_.size();
  for (Timepoint t = 0; t < model_.horizon; ++t) {
    const auto step = model_.step_at[static_cast<std::size_t>(t)];
    std::vector<std::uint32_t> next;
    for (const auto node : layers_.back()) {
      if (!edges_[step].contains(node) && !expand_node(step, node, reason)) return false;
      for (const auto& edge : edges_[step].at(node)) next.push_back(edge.target);
    }
    sort_out(next);
    total += next.size();
    layers_.push_back(std::move(next));
    if (total > limits_.nodes) return give_up(reason);
  }
  return true;
}

bool TraceGraph::expand_node(std::uint32_t step, std::uint32_t node, std::string& reason) {
  std::map<std::pair<Bits, Bits>, std::vector<Bits>> ways;  // by events and observed
  const auto& from = *nodes_[node];
  for (const auto& hidden : from.hidden) {
    std::vector<Literal> state;
    assume(before_, from.observed, state);
    assume(std::span(before_).subspan(from.observed.size()), hidden, state);
    auto found = moves(steps_[step], state, limits_.edges - move_count_);
    if (!found) return give_up(reason);
    move_count_ += found->size();
    for (auto& move : *found) {
      ways[{std::move(move.events), std::move(move.observed)}].push_back(std::move(move.hidden));
    }
  }
  const auto* orbits = orbits_ == nullptr ? nullptr : &orbits_->later;
  auto& edges = edges_[step][node];
  for (auto& [way, hidden] : ways) {
    std::sort(hidden.begin(), hidden.end());
    hidden.erase(std::unique(hidden.begin(), hidden.end()), hidden.end());
    edges.push_back({intern_events(way.first), intern({way.second, std::move(hidden)}, orbits)});
  }
  edge_count_ += edges.size();
  return true;
}

bool TraceGraph::give_up(std::string& reason) const {
  reason = stop_ != nullptr && stop_->load() ? "it was stopped" : "the graph has too many states";
  if (needs_solver_) reason = kWantsSolver;
  return false;
}

void TraceGraph::count_back() {
  completions_.resize(layers_.size());
  for (const auto node : layers_.back()) completions_.back()[node] = 1;
  for (auto t = model_.horizon; t-- > 0;) {
    const auto here = static_cast<std::size_t>(t);
    for (const auto node : layers_[here]) {
      mpz_class sum = 0;
      for (const auto& edge : edges(t, node)) sum += completions_[here + 1].at(edge.target);
      completions_[here][node] = std::move(sum);
    }
  }
  for (const auto node : starts_) total_ += completions_[0].at(node);
}

const mpz_class& TraceGraph::completions(Timepoint t, std::uint32_t node) const {
  return completions_[static_cast<std::size_t>(t)].at(node);
}

const std::vector<GraphEdge>& TraceGraph::edges(Timepoint t, std::uint32_t node) const {
  return edges_[model_.step_at[static_cast<std::size_t>(t)]].at(node);
}

std::int64_t TraceGraph::work() const {
  auto work = start_.work();
  for (const auto& step : steps_) work += step.work();
  return work;
}

std::int64_t TraceGraph::solve_calls() const {
  auto calls = start_.solve_calls();
  for (const auto& step : steps_) calls += step.solve_calls();
  return calls;
}

}  // namespace parallax::runtime
