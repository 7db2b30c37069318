// Three ways to list the traces of a model without constraints.
//
// Blocking: each trace is moved to canonical order (canonical.cc) and excluded by a clause for
// good; the first traces come fast, later ones ever more slowly. Tree: the atoms are cut into
// levels; at a node, the values of the levels above are assumed, and the values of the next
// level are found by blocking clauses under a guard that is retired before a child is entered,
// so that only the blocking clauses of one node are active at a time. A level with more than
// about a thousand children is halved. Search: clause_search.cc, whose next answer costs the
// same however many came before, and which gives up by conflicts.
//
// The tree and the search list traces in canonical order, and blocking does so if it is asked
// to.

#include "runtime/enumerate/model_enumerator.h"

#include <algorithm>
#include <utility>

#include "runtime/enumerate/canonical.h"
#include "runtime/enumerate/trace_source.h"

namespace parallax::runtime {

ModelEnumerator::ModelEnumerator(SolverSession& session, Distinct distinct, TraceOrder order,
                                 SymmetryBreaker* breaker)
    : session_(&session), symbols_(symbols_of(session.model())), wanted_(order), breaker_(breaker) {
  for (const auto atom : projected_atoms(session.model(), distinct)) order_.push_back(~atom);
}

std::optional<Trace> ModelEnumerator::next() {
  const auto n = session_->model().horizon;
  if (exhausted_) return std::nullopt;
  std::vector<Literal> assumptions;
  if (breaker_ != nullptr) assumptions.push_back(breaker_->assumption());
  const auto status = session_->solve(n, assumptions);
  exhausted_ = status == SolveStatus::kUnsatisfiable;
  by_symmetry_ = exhausted_ && breaker_ != nullptr && session_->failed(assumptions.front());
  if (status != SolveStatus::kSatisfiable) return std::nullopt;
  auto found = in_order(*session_, n, assumptions, order_, wanted_);
  if (!found) return std::nullopt;
  has_more_ = found->has_others;
  // The traces that are left without the first one tell constants apart.
  if (breaker_ != nullptr) std::exchange(breaker_, nullptr)->retire();
  session_->require_model(n);
  auto trace = decode_trace(session_->model(), symbols_, n,
                            [&](Literal literal) { return session_->value(literal); });
  trace.number = ++found_;
  for (auto& literal : found->literals) literal = ~literal;
  session_->add_clause(found->literals);
  return trace;
}

void ModelEnumerator::look_on() {
  if (found_ == 0) {
    (void)next();
  } else if (!exhausted_ && !has_more_) {
    exhausted_ = session_->solve(session_->model().horizon, {}) == SolveStatus::kUnsatisfiable;
  }
}

SourceStats ModelEnumerator::stats() const {
  SourceStats stats;
  stats.strategy = "blocking";
  stats.solve_calls = session_->solve_calls();
  stats.by_symmetry = by_symmetry_;
  return stats;
}

namespace {

/// A node costs one call for each child and one more, and blocking clauses slow the calls down:
/// with 256 to 1024 children traces come four times as fast as with a level for every timepoint.
constexpr std::size_t kMostChildren = 1024;

}  // namespace

TraceTree::TraceTree(SolverSession& session, std::vector<std::vector<Literal>> levels,
                     std::string name, std::size_t most_children)
    : session_(&session),
      symbols_(symbols_of(session.model())),
      levels_(std::move(levels)),
      name_(std::move(name)),
      most_children_(most_children) {
  std::erase_if(levels_, [](const auto& level) { return level.empty(); });
  if (levels_.empty()) levels_.emplace_back();  // one trace, or none
}

std::optional<Trace> TraceTree::next() {
  if (exhausted_ || stopped_) return std::nullopt;
  if (!std::exchange(started_, true)) stopped_ = !expand();
  if (stopped_) return std::nullopt;
  while (!path_.empty()) {
    auto& node = path_.back();
    assumptions_.erase(assumptions_.begin() + static_cast<std::ptrdiff_t>(node.assumed),
                       assumptions_.end());
    if (node.next == node.children.size()) {
      path_.pop_back();
      continue;
    }
    auto& child = node.children[node.next++];
    if (path_.size() == levels_.size()) {
      child.trace.number = ++found_;
      return std::move(child.trace);
    }
    const auto& level = levels_[path_.size() - 1];
    for (std::size_t i = 0; i < level.size(); ++i) {
      assumptions_.push_back(child.values[i] ? level[i] : ~level[i]);
    }
    stopped_ = !expand();
    if (stopped_) return std::nullopt;
  }
  exhausted_ = true;
  return std::nullopt;
}

/// Adds the node below the path; false if the solver was stopped.
bool TraceTree::expand() {
  const auto level = path_.size();
  while (true) {
    Node node;
    node.assumed = assumptions_.size();
    bool too_many = false;
    if (!find_children(node, too_many)) return false;
    if (too_many) {
      halve(level);
      continue;
    }
    std::sort(node.children.begin(), node.children.end(),
              [](const Child& a, const Child& b) { return a.values < b.values; });
    path_.push_back(std::move(node));
    return true;
  }
}

bool TraceTree::find_children(Node& node, bool& too_many) {
  const auto n = session_->model().horizon;
  const auto& level = levels_[path_.size()];
  const bool is_last = path_.size() + 1 == levels_.size();
  const auto guard = session_->new_variable();
  auto assumed = assumptions_;
  assumed.push_back(guard);
  std::vector<Literal> blocking;
  auto status = SolveStatus::kUnsatisfiable;
  while ((status = session_->solve(n, assumed)) == SolveStatus::kSatisfiable) {
    too_many = node.children.size() == most_children_ && level.size() > 1;
    if (too_many) break;
    auto& child = node.children.emplace_back();
    blocking = {~guard};
    for (const auto atom : level) {
      child.values.push_back(session_->value(atom));
      blocking.push_back(child.values.back() ? ~atom : atom);
    }
    if (is_last) {
      session_->require_model(n);
      child.trace = decode_trace(session_->model(), symbols_, n,
                                 [&](Literal literal) { return session_->value(literal); });
    }
    session_->add_clause(blocking);
  }
  session_->add_clause(std::vector{~guard});
  return status != SolveStatus::kUnknown;
}

void TraceTree::halve(std::size_t level) {
  auto& atoms = levels_[level];
  const auto middle = atoms.begin() + static_cast<std::ptrdiff_t>(atoms.size() / 2);
  std::vector<Literal> rest(middle, atoms.end());
  atoms.erase(middle, atoms.end());
  levels_.insert(levels_.begin() + static_cast<std::ptrdiff_t>(level) + 1, std::move(rest));
}

SourceStats TraceTree::stats() const {
  SourceStats stats;
  stats.strategy = name_;
  stats.solve_calls = session_->solve_calls();
  return stats;
}

std::unique_ptr<TraceTree> make_trace_tree(SolverSession& session, Distinct distinct) {
  return std::make_unique<TraceTree>(
      session, std::vector<std::vector<Literal>>{projected_atoms(session.model(), distinct)},
      "tree", kMostChildren);
}

std::unique_ptr<TraceTree> make_guarded_blocking(SolverSession& session, Distinct distinct) {
  const auto blocks = projection_blocks(session.model(), distinct);
  std::vector<std::vector<Literal>> halves(2);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    auto& half = halves[2 * i < blocks.size() ? 0 : 1];
    half.insert(half.end(), blocks[i].begin(), blocks[i].end());
  }
  return std::make_unique<TraceTree>(session, std::move(halves), "guarded", kMostChildren);
}

namespace {

/// Number of conflicts between two looks at the stop flag.
constexpr std::int64_t kSlice = 1000;

}  // namespace

SearchTraces::SearchTraces(const CompiledModel& model, Distinct distinct,
                           const std::atomic<bool>* stop, std::int64_t conflicts)
    : model_(model),
      symbols_(symbols_of(model)),
      stop_(stop),
      conflicts_(conflicts),
      search_(model.variable_count(), projected_atoms(model, distinct)) {
  for (std::size_t c = 0; c < model.clauses.size(); ++c) search_.add_clause(model.clauses[c]);
  search_.begin({});
}

std::optional<Trace> SearchTraces::next() {
  using Status = ClauseSearch::Status;
  if (exhausted_ || gave_up_) return std::nullopt;
  auto status = Status::kGaveUp;
  paused_ = false;
  while (status == Status::kGaveUp && spent_ < conflicts_ && !paused_) {
    if (stop_ != nullptr && stop_->load()) return std::nullopt;
    const auto before = search_.conflicts();
    status = search_.next(std::min(conflicts_ - spent_, kSlice), pause_at_);
    spent_ += search_.conflicts() - before;
    paused_ = status == Status::kGaveUp && work() >= pause_at_;
  }
  exhausted_ = status == Status::kNoMore;
  gave_up_ = status == Status::kGaveUp && !paused_;
  if (status != Status::kFound) return std::nullopt;
  spent_ = 0;
  const auto value = [&](Literal literal) { return search_.value(literal); };
  for (std::size_t c = 0; c < model_.clauses.size(); ++c) {
    const auto clause = model_.clauses[c];
    PARALLAX_REQUIRE(std::any_of(clause.begin(), clause.end(), value),
                     "what the search finds satisfies every clause");
  }
  auto trace = decode_trace(model_, symbols_, model_.horizon, value);
  trace.number = ++found_;
  return trace;
}

SourceStats SearchTraces::stats() const {
  SourceStats stats;
  stats.strategy = "search";
  return stats;
}

}  // namespace parallax::runtime
