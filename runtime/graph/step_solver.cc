#include "runtime/graph/step_solver.h"

#include <algorithm>

namespace parallax::runtime {

StepSolver::StepSolver(const LayeredModel& model, const WindowClauses& window, bool is_start,
                       const std::atomic<bool>* stop)
    : model_(model),
      window_(window),
      is_start_(is_start),
      solver_(make_cadical_solver(stop)),
      next_guard_(window.variables + 1) {
  std::vector<Literal> clause;
  for (const auto& written : window.clauses) {
    clause.clear();
    for (const auto literal : written) clause.push_back(Literal::from_dimacs(literal));
    solver_->add_clause(clause);
  }
  const auto slots = static_cast<std::int32_t>(model.state_slots);
  const auto project = [&](std::uint32_t slot, std::int32_t offset) {
    projection_.push_back(Literal::positive(offset + static_cast<std::int32_t>(slot) + 1));
    solver_->set_phase(~projection_.back());
  };
  if (!is_start) {
    for (const auto slot : model.events) project(slot, slots);
  }
  for (const auto slot : model.observed) project(slot, is_start ? 0 : slots);
  for (const auto slot : model.hidden) project(slot, is_start ? 0 : slots);
}

std::optional<std::vector<Move>> StepSolver::moves(const Bits& observed, const Bits& hidden,
                                                   std::size_t limit) {
  const auto guard = Literal::positive(next_guard_++);
  std::vector<Literal> assumptions = {guard};
  const auto assume = [&](const std::vector<std::uint32_t>& slots, const Bits& values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto literal = Literal::positive(static_cast<std::int32_t>(slots[i]) + 1);
      assumptions.push_back(values[i] ? literal : ~literal);
    }
  };
  assume(model_.observed, observed);
  assume(model_.hidden, hidden);
  std::vector<Move> found;
  std::vector<Literal> blocking;
  while (true) {
    for (const auto literal : assumptions) solver_->assume(literal);
    const auto status = solver_->solve();
    if (status == SolveStatus::kUnknown || found.size() == limit) return std::nullopt;
    if (status == SolveStatus::kUnsatisfiable) break;
    require_window();
    found.push_back(read());
    blocking = {~guard};
    for (const auto literal : projection_) {
      blocking.push_back(solver_->value(literal) ? ~literal : literal);
    }
    solver_->add_clause(blocking);
  }
  solver_->add_clause(std::vector{~guard});
  return found;
}

/// Every way is evaluated once, without the solver.
void StepSolver::require_window() const {
  for (const auto& clause : window_.clauses) {
    PARALLAX_REQUIRE(std::any_of(clause.begin(), clause.end(),
                                 [&](std::int32_t literal) {
                                   return solver_->value(Literal::from_dimacs(literal));
                                 }),
                     "the solver's valuations satisfy every clause");
  }
}

Move StepSolver::read() const {
  Move move;
  std::size_t next = 0;
  const auto take = [&](std::size_t count, Bits& bits) {
    bits.reserve(count);
    for (std::size_t i = 0; i < count; ++i) bits.push_back(solver_->value(projection_[next++]));
  };
  if (!is_start_) take(model_.events.size(), move.events);
  take(model_.observed.size(), move.observed);
  take(model_.hidden.size(), move.hidden);
  return move;
}

}  // namespace parallax::runtime
