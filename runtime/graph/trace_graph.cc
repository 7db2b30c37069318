#include "runtime/graph/trace_graph.h"

#include <algorithm>
#include <functional>
#include <map>
#include <utility>

namespace parallax::runtime {

TraceGraph::TraceGraph(const LayeredModel& model, const GraphLimits& limits,
                       const std::atomic<bool>* stop)
    : model_(model), limits_(limits), stop_(stop), start_(model, model.start, true, stop) {
  for (const auto& step : model.steps) {
    steps_.push_back(std::make_unique<StepSolver>(model, step, false, stop));
  }
  edges_.resize(model.steps.size());
}

std::unique_ptr<TraceGraph> TraceGraph::build(const LayeredModel& model, const GraphLimits& limits,
                                              const std::atomic<bool>* stop, std::string& reason) {
  auto graph = std::unique_ptr<TraceGraph>(new TraceGraph(model, limits, stop));
  if (!graph->expand(reason)) return nullptr;
  graph->count_back();
  return graph;
}

std::size_t GraphNodeHash::operator()(const GraphNode& node) const {
  const std::hash<Bits> of_bits;
  auto hash = of_bits(node.observed);
  for (const auto& hidden : node.hidden) hash = hash * 0x9E3779B97F4A7C15U + of_bits(hidden);
  return hash;
}

std::uint32_t TraceGraph::intern(GraphNode node) {
  if (node.hidden.size() > 1) determined_ = false;
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

bool TraceGraph::expand(std::string& reason) {
  auto moves = start_.moves({}, {}, {limits_.nodes, limits_.conflicts});
  if (!moves) return give_up(reason);
  std::map<Bits, std::vector<Bits>> starts;
  for (auto& move : *moves) starts[move.observed].push_back(std::move(move.hidden));
  for (auto& [observed, hidden] : starts) {
    std::sort(hidden.begin(), hidden.end());
    starts_.push_back(intern({observed, std::move(hidden)}));
  }
  layers_.push_back(starts_);
  std::size_t total = starts_.size();
  for (Timepoint t = 0; t < model_.horizon; ++t) {
    const auto step = model_.step_at[static_cast<std::size_t>(t)];
    std::vector<std::uint32_t> next;
    for (const auto node : layers_.back()) {
      if (!edges_[step].contains(node) && !expand_node(step, node, reason)) return false;
      for (const auto& edge : edges_[step].at(node)) next.push_back(edge.target);
    }
    std::sort(next.begin(), next.end());
    next.erase(std::unique(next.begin(), next.end()), next.end());
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
    auto moves = steps_[step]->moves(from.observed, hidden, {limits_.edges, limits_.conflicts});
    if (!moves) return give_up(reason);
    for (auto& move : *moves) {
      ways[{std::move(move.events), std::move(move.observed)}].push_back(std::move(move.hidden));
    }
  }
  auto& edges = edges_[step][node];
  for (auto& [way, hidden] : ways) {
    std::sort(hidden.begin(), hidden.end());
    hidden.erase(std::unique(hidden.begin(), hidden.end()), hidden.end());
    edges.push_back({intern_events(way.first), intern({way.second, std::move(hidden)})});
  }
  edge_count_ += edges.size();
  return edge_count_ <= limits_.edges || give_up(reason);
}

bool TraceGraph::give_up(std::string& reason) const {
  reason = stop_ != nullptr && stop_->load() ? "it was stopped" : "the graph has too many states";
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

std::int64_t TraceGraph::solve_calls() const {
  auto calls = start_.solve_calls();
  for (const auto& step : steps_) calls += step->solve_calls();
  return calls;
}

}  // namespace parallax::runtime
