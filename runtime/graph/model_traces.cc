// Chooses how the traces of a model are listed.
//
// No strategy is best for all models, and which one is shows only when it is tried. A few traces
// are found by search. If more are wanted, the search begins and is paused after a few
// milliseconds; then graphs of growing size and the search take turns, each with about the work
// that the other has done, so the loss against the better one is a constant factor. A search
// that meets too many conflicts gives way to a graph or a solver: blocking if no trace was found
// yet, else the tree, which passes over the traces that were given. All list the same traces in
// canonical order, so the change is not seen. A trace far ahead is sought by a graph or by
// components, which can count, else by listing.
//
// Before a solver is given single states it is asked whether there is any trace at all, which
// symmetry may make easy.

#include "runtime/graph/model_traces.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "runtime/cubes/cube_solver.h"
#include "runtime/enumerate/canonical.h"
#include "runtime/enumerate/model_enumerator.h"
#include "runtime/graph/far_atoms.h"
#include "runtime/symmetry/lex_leader.h"

namespace parallax::runtime {
namespace {

/// For more traces than this, a graph that takes some seconds pays off.
constexpr std::int64_t kFew = 1000;
/// Conflicts of a search for one trace; beyond them a solver takes over.
constexpr std::int64_t kConflicts = 1000;
/// Conflicts within which symmetry shows, where it makes that easy, that there is no trace.
constexpr std::int64_t kEasy = 20'000;

}  // namespace

ModelTraces::ModelTraces(const CompiledModel& model, TraceQuery query)
    : model_(model), query_(query) {
  switch (query.strategy) {
    case Strategy::kAuto:
      if (query.wanted > 0 && query.wanted <= kFew) {
        // The first traces in canonical order are found by search, any traces by the solver.
        if (query.order == TraceOrder::kCanonical) use_search(kConflicts);
      } else {
        attempts_ = {{kFar, query.limits},
                     {1, kMediumGraph.within(query.limits)},
                     {0, kSmallGraph.within(query.limits)}};
        use_search(kConflicts);
        if (query.search_first > 0) {
          search_->pause_at(query.search_first + 2 * std::int64_t{model.variable_count()});
        } else {
          search_->pause_at(0);
        }
      }
      break;
    case Strategy::kSearch:
      use_search(std::numeric_limits<std::int64_t>::max());
      break;
    case Strategy::kBlocking:
      break;
    case Strategy::kGuarded:
      source_ = make_guarded_blocking(session(), query.distinct);
      break;
    case Strategy::kTree:
      source_ = make_trace_tree(session(), query.distinct);
      break;
    case Strategy::kGraph:
      use_graph(query.limits);
      if (paths_ == nullptr) refusal_ = remark_;
      break;
    case Strategy::kComponents:
      if (!use_components(ComponentEffort::kFull))
        refusal_ = "they are more components than can be counted";
      break;
  }
  if (source_ == nullptr) use_blocking();
}

SolverSession& ModelTraces::session() {
  if (!session_) {
    const bool is_one = query_.order == TraceOrder::kAny || query_.wanted == 1;
    session_.emplace(model_, make_solver_for_jobs(query_.jobs, query_.stop),
                     is_one ? Loading::kWitness : Loading::kAsNeeded);
    if (may_break_symmetry()) break_symmetry();
  }
  return *session_;
}

/// For the first call; the first trace in canonical order is the first one of its orbit, too.
void ModelTraces::break_symmetry() {
  const ModelSymmetry symmetry(model_);
  if (symmetry.known_order() < kWorthBreaking) return;
  session_->load(model_.horizon);
  const auto order = whole_order(model_, projection_blocks(model_, query_.distinct));
  breaker_.emplace(*session_, symmetry.all(), order);
  breaker_->extend(order.size());
}

SolveStatus ModelTraces::has_trace() {
  auto& asked = session();
  std::vector<Literal> assumptions;
  if (breaker_) assumptions.push_back(breaker_->assumption());
  return asked.solve(model_.horizon, assumptions);
}

void ModelTraces::use_blocking() {
  auto& asked = session();
  source_ = std::make_unique<ModelEnumerator>(asked, query_.distinct, query_.order,
                                              breaker_ ? &*breaker_ : nullptr);
}

void ModelTraces::use_search(std::int64_t conflicts) {
  auto search = std::make_unique<SearchTraces>(model_, query_.distinct, query_.stop, conflicts);
  search_ = search.get();
  source_ = std::move(search);
}

void ModelTraces::use_graph(const GraphLimits& limits) {
  remark_.clear();
  is_tried_ = true;
  if (graph_.layered == nullptr) {
    auto split = split_into_windows(model_, query_.distinct, FixedTies::kCarried);
    if (auto* layered = std::get_if<LayeredModel>(&split)) {
      graph_.layered = std::make_unique<LayeredModel>(std::move(*layered));
    } else {
      remark_ = std::get<std::string>(split);
      return;
    }
  }
  // Clauses that are in no window are left to the solver.
  if (graph_.layered->has_unplaced && given_ == 0 && has_trace() != SolveStatus::kSatisfiable) {
    return;
  }
  // Before a solver is given single states, it is asked whether there is any trace at all, which
  // symmetry can make easy.
  auto without_solver = limits;
  without_solver.solver = given_ > 0 || !may_break_symmetry();
  std::int64_t work = 0;
  graph_.graph =
      TraceGraph::build(*graph_.layered, without_solver, query_.stop, remark_, nullptr, &work);
  graph_work_ = work;
  if (graph_.graph == nullptr && remark_ == TraceGraph::kWantsSolver) {
    (void)session();
    if (breaker_) {
      session().limit_conflicts(kEasy);
      if (has_trace() == SolveStatus::kUnsatisfiable) return;
    }
    graph_.graph = TraceGraph::build(*graph_.layered, limits, query_.stop, remark_, nullptr, &work);
    graph_work_ += work;
  }
  if (graph_.graph == nullptr) return;
  remark_ = GraphPaths::obstacle(*graph_.graph, model_);
  if (!remark_.empty()) return;
  auto paths = std::make_unique<GraphPaths>(*graph_.graph, model_);
  if (given_ > 0) paths->seek(given_);
  paths_ = paths.get();
  search_ = nullptr;
  source_ = std::move(paths);
}

bool ModelTraces::use_components(ComponentEffort effort) {
  auto components = std::make_unique<ComponentTraces>(model_, query_.distinct, query_.stop, effort);
  if (!components->total()) return false;
  components->seek(given_);
  components_ = components.get();
  search_ = nullptr;
  source_ = std::move(components);
  return true;
}

void ModelTraces::use_tree() {
  // The blocking clauses must not hold in the tree.
  search_ = nullptr;
  tree_session_.emplace(model_, make_cadical_solver(query_.stop));
  source_ = make_trace_tree(*tree_session_, query_.distinct);
  for (std::int64_t i = 0; i < given_ && source_->next(); ++i) continue;
}

/// After the last attempt the tree takes over from a solver that excludes what it has found.
void ModelTraces::attempt_graph() {
  const auto limits = attempts_.back().limits;
  attempts_.pop_back();
  if (can_grow()) use_graph(limits);
  if (paths_ != nullptr) attempts_.clear();
  if (paths_ == nullptr && search_ == nullptr && !tree_session_ && attempts_.empty()) use_tree();
}

/// Leaves the search after too many conflicts: the graph or a solver is better from here on.
void ModelTraces::leave_search() {
  search_ = nullptr;
  if (!is_tried_) {
    const auto limits = attempts_.empty() ? kSmallGraph : attempts_.back().limits;
    if (!attempts_.empty()) attempts_.pop_back();
    use_graph(limits);
  }
  if (paths_ != nullptr) return;
  if (given_ == 0) {
    use_blocking();
  } else {
    use_tree();
  }
}

/// The search and the graph take turns, each with about the work that the other has done.
bool ModelTraces::change_source() {
  if (search_ == nullptr) return false;
  const auto graphs_left = attempts_.size();
  if (search_->gave_up()) {
    leave_search();
  } else if (search_->is_paused()) {
    if (!attempts_.empty()) attempt_graph();
  } else {
    return false;
  }
  if (search_ != nullptr) {
    search_->pause_at(attempts_.empty() ? std::numeric_limits<std::int64_t>::max()
                                        : search_->work() + graph_work_);
  }
  return !query_.number_only || attempts_.size() == graphs_left;
}

std::optional<Trace> ModelTraces::next() {
  if (is_due()) attempt_graph();
  auto trace = source_->next();
  while (!trace && change_source()) trace = source_->next();
  if (trace) ++given_;
  return trace;
}

void ModelTraces::look_on() {
  if (is_due()) attempt_graph();
  source_->look_on();
  while (change_source()) source_->look_on();
}

bool ModelTraces::print_next(const TraceFormat& format, std::string& out) {
  if (paths_ == nullptr && components_ == nullptr) return TraceSource::print_next(format, out);
  const bool found = source_->print_next(format, out);
  if (found) ++given_;
  return found;
}

void ModelTraces::seek(const mpz_class& before) {
  if (query_.strategy == Strategy::kAuto && paths_ == nullptr && before >= kFar) {
    attempts_.clear();
    // Atoms that clauses tie together from afar have to be carried along in a graph.
    const bool falls_apart = looks_far(model_) && use_components(ComponentEffort::kTrial);
    if (!falls_apart && can_grow()) use_graph(query_.limits);
    if (!falls_apart && paths_ == nullptr && !use_components(ComponentEffort::kFull)) use_tree();
  }
  if (paths_ != nullptr) return paths_->seek(before);
  if (components_ != nullptr) return components_->seek(before);
  for (mpz_class i = given_; i < before && next(); ++i) continue;
}

SourceStats ModelTraces::stats() const {
  auto stats = source_->stats();
  stats.remark = remark_;
  if (paths_ != nullptr && session_) stats.solve_calls += session_->solve_calls();
  return stats;
}

}  // namespace parallax::runtime
