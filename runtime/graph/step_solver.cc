#include "runtime/graph/step_solver.h"

#include <algorithm>

namespace parallax::runtime {
namespace {

/// A state that meets more conflicts than this is left to the solver, and so are those after it.
constexpr std::int64_t kConflicts = 2000;

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
    start_solver();
  }
  return solve(state, limits.moves);
}

/// kFound: it was stopped, or there are too many.
ClauseSearch::Status StepSolver::search(const std::vector<Literal>& state, const MoveLimits& limits,
                                        std::vector<Move>& found) {
  const auto value = [&](Literal literal) { return search_.value(literal); };
  const auto last = std::min(search_.conflicts() + kConflicts, limits.conflicts);
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

}  // namespace parallax::runtime
