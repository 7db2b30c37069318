// The traces of a model as the paths of a layered graph, so that cost grows with states and not
// with traces.
//
// A window of clauses ties the state before a step to the events and the state after it
// (layered_model.cc). A node is an observed state with all valuations of the hidden slots that
// some trace with the same observations can have (subset construction, Rabin and Scott 1959), so
// different paths are different traces. Each node is expanded once for each distinct window,
// whenever it is reached. The ways on are listed by search (clause_search.cc); a window that
// meets too many conflicts is given to a solver that learns and blocks. Every way on is checked
// against the clauses of its window. From the last layer backwards each node gets the exact
// number of its completions, whose sum over the starts is the number of traces.
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

/// A state that meets more conflicts than this is left to the solver, and so are those after it.
constexpr std::int64_t kSearchConflicts = 2000;

std::vector<Literal> projection(const LayeredModel& model, bool is_start) {
  std::vector<Literal> out;
  const auto slots = static_cast<std::int32_t>(model.state_slots);
  const auto project = [&](const std::vector<std::uint32_t>& some, std::int32_t offset) {
    for (const auto slot : some) {
      out.push_back(Literal::positive(offset + static_cast<std::int32_t>(slot) + 1));
    }
  };
  if (!is_start) project(model.events, slots);
  project(model.observed, is_start ? 0 : slots);
  project(model.hidden, is_start ? 0 : slots);
  return out;
}

std::vector<std::vector<Literal>> literals(const WindowClauses& window) {
  std::vector<std::vector<Literal>> out;
  for (const auto& written : window.clauses) {
    auto& clause = out.emplace_back();
    for (const auto literal : written) clause.push_back(Literal::from_dimacs(literal));
  }
  return out;
}

/// Each once.
void sort_out(std::vector<std::uint32_t>& nodes) {
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
}

}  // namespace

StepSolver::StepSolver(const LayeredModel& model, const WindowClauses& window, bool is_start,
                       const std::atomic<bool>* stop)
    : model_(model),
      window_(window),
      is_start_(is_start),
      stop_(stop),
      projection_(projection(model, is_start)),
      search_(window.variables, projection_),
      next_guard_(window.variables + 1) {
  for (const auto& clause : literals(window)) search_.add_clause(clause);
}

std::optional<std::vector<Move>> StepSolver::moves(const Bits& observed, const Bits& hidden,
                                                   const MoveLimits& limits) {
  std::vector<Literal> state;
  const auto assume = [&](const std::vector<std::uint32_t>& slots, const Bits& values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto literal = Literal::positive(static_cast<std::int32_t>(slots[i]) + 1);
      state.push_back(values[i] ? literal : ~literal);
    }
  };
  assume(model_.observed, observed);
  assume(model_.hidden, hidden);
  std::vector<Move> found;
  if (solver_ == nullptr) {
    const auto status = search(state, limits, found);
    if (status == ClauseSearch::Status::kNoMore) return found;
    if (status == ClauseSearch::Status::kFound || is_spent(limits)) return std::nullopt;
    if (!limits.solver) {
      wants_solver_ = true;
      return std::nullopt;
    }
    start_solver();
  }
  return solve(state, limits.moves);
}

/// kFound: it was stopped, or there are too many.
ClauseSearch::Status StepSolver::search(const std::vector<Literal>& state, const MoveLimits& limits,
                                        std::vector<Move>& found) {
  const auto value = [&](Literal literal) { return search_.value(literal); };
  const auto last = std::min(search_.conflicts() + kSearchConflicts, limits.conflicts);
  search_.begin(state);
  while (true) {
    const auto status = search_.next(last - search_.conflicts());
    if (status != ClauseSearch::Status::kFound || is_stopped() || found.size() == limits.moves) {
      return status;
    }
    require_window(value);
    found.push_back(read(value));
  }
}

void StepSolver::start_solver() {
  solver_ = make_cadical_solver(stop_);
  for (const auto& clause : literals(window_)) solver_->add_clause(clause);
  for (const auto literal : projection_) solver_->set_phase(~literal);
}

std::optional<std::vector<Move>> StepSolver::solve(const std::vector<Literal>& state,
                                                   std::size_t limit) {
  const auto guard = Literal::positive(next_guard_++);
  const auto value = [&](Literal literal) { return solver_->value(literal); };
  std::vector<Move> found;
  std::vector<Literal> blocking;
  while (true) {
    solver_->assume(guard);
    for (const auto literal : state) solver_->assume(literal);
    const auto status = solver_->solve();
    if (status == SolveStatus::kUnknown || found.size() == limit) return std::nullopt;
    if (status == SolveStatus::kUnsatisfiable) break;
    require_window(value);
    found.push_back(read(value));
    blocking = {~guard};
    for (const auto literal : projection_) blocking.push_back(value(literal) ? ~literal : literal);
    solver_->add_clause(blocking);
  }
  solver_->add_clause(std::vector{~guard});
  std::sort(found.begin(), found.end());
  return found;
}

/// Every way is evaluated once on the clauses themselves.
template <typename Value>
void StepSolver::require_window(const Value& value) const {
  for (const auto& clause : window_.clauses) {
    PARALLAX_REQUIRE(
        std::any_of(clause.begin(), clause.end(),
                    [&](std::int32_t literal) { return value(Literal::from_dimacs(literal)); }),
        "what a window admits satisfies every clause of it");
  }
}

template <typename Value>
Move StepSolver::read(const Value& value) const {
  Move move;
  std::size_t next = 0;
  const auto take = [&](std::size_t count, Bits& bits) {
    bits.reserve(count);
    for (std::size_t i = 0; i < count; ++i) bits.push_back(value(projection_[next++]));
  };
  if (!is_start_) take(model_.events.size(), move.events);
  take(model_.observed.size(), move.observed);
  take(model_.hidden.size(), move.hidden);
  return move;
}

TraceGraph::TraceGraph(const LayeredModel& model, const GraphLimits& limits,
                       const std::atomic<bool>* stop, const GraphOrbits* orbits)
    : model_(model),
      limits_(limits),
      stop_(stop),
      orbits_(orbits),
      start_(model, model.start, true, stop) {
  for (const auto& step : model.steps) {
    steps_.push_back(std::make_unique<StepSolver>(model, step, false, stop));
  }
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

bool TraceGraph::expand(std::string& reason) {
  const auto most = std::min(limits_.nodes, limits_.edges);
  auto moves = start_.moves({}, {}, {most, limits_.conflicts, limits_.solver});
  if (!moves) return give_up(reason);
  const auto* orbits = orbits_ == nullptr ? nullptr : &orbits_->at_start;
  std::map<Bits, std::vector<Bits>> starts;
  for (auto& move : *moves) starts[move.observed].push_back(std::move(move.hidden));
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
    auto moves = steps_[step]->moves(
        from.observed, hidden, {limits_.edges - move_count_, limits_.conflicts, limits_.solver});
    if (!moves) return give_up(reason);
    move_count_ += moves->size();
    for (auto& move : *moves) {
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

bool TraceGraph::wants_solver() const {
  return start_.wants_solver() || std::any_of(steps_.begin(), steps_.end(), [](const auto& step) {
           return step->wants_solver();
         });
}

bool TraceGraph::give_up(std::string& reason) const {
  reason = stop_ != nullptr && stop_->load() ? "it was stopped" : "the graph has too many states";
  if (wants_solver()) reason = kWantsSolver;
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
  for (const auto& step : steps_) work += step->work();
  return work;
}

std::int64_t TraceGraph::solve_calls() const {
  auto calls = start_.solve_calls();
  for (const auto& step : steps_) calls += step->solve_calls();
  return calls;
}

}  // namespace parallax::runtime
