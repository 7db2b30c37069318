// Successors of a state in one window of a model, and the least events that it demands.
//
// States come from a query that lists all valuations of the slots after the step, sorted, so
// that a draw depends on the seed alone. Least sets of events: if nothing else has to happen,
// the given events are the only one. Otherwise a valuation is found and its events are reduced,
// each time by a clause under a guard that some of them is absent and an assumption that no
// other happens, until none can be left out; then all supersets of the set are excluded, and the
// next one is sought. So each set is minimal by inclusion, and none is missed. Cost: for each
// set as many calls as events are left out, and two more; there may be exponentially many sets.

#include "harness/discrete/window_solver.h"

#include <algorithm>

namespace parallax::harness {

using runtime::Literal;
using runtime::SolveStatus;

WindowSolver::WindowSolver(const runtime::LayeredModel& model, const runtime::WindowClauses& window,
                           bool is_start, const std::atomic<bool>* stop)
    : model_(model),
      is_start_(is_start),
      query_(window, {}, window.variables, states_after(), stop),
      solver_(runtime::make_cadical_solver(stop)),
      next_guard_(window.variables + 1) {
  std::vector<Literal> clause;
  for (const auto& written : window.clauses) {
    clause.clear();
    for (const auto literal : written) clause.push_back(Literal::from_dimacs(literal));
    solver_->add_clause(clause);
  }
}

std::vector<Literal> WindowSolver::states_after() const {
  std::vector<Literal> out;
  for (const auto slot : model_.observed) out.push_back(after(slot));
  for (const auto slot : model_.hidden) out.push_back(after(slot));
  return out;
}

SolveStatus WindowSolver::solve(std::span<const Literal> given, std::span<const Literal> more) {
  for (const auto literal : given) solver_->assume(literal);
  for (const auto literal : more) solver_->assume(literal);
  return solver_->solve();
}

ListEnd WindowSolver::states(std::span<const Literal> given, std::size_t limit,
                             std::vector<runtime::Move>& out) {
  const auto answer = query_.ask(given, limit);
  const auto observed = static_cast<std::ptrdiff_t>(model_.observed.size());
  for (const auto& state : answer.found) {
    auto& move = out.emplace_back();
    move.observed.assign(state.begin(), state.begin() + observed);
    move.hidden.assign(state.begin() + observed, state.end());
  }
  std::sort(out.begin(), out.end());
  if (answer.complete) return ListEnd::kComplete;
  return answer.found.size() == limit ? ListEnd::kTooMany : ListEnd::kStopped;
}

std::vector<std::size_t> WindowSolver::events_at_hand() const {
  std::vector<std::size_t> happening;
  for (std::size_t i = 0; i < model_.events.size(); ++i) {
    if (solver_->value(event(i))) happening.push_back(i);
  }
  return happening;
}

/// Leaves out events of a set that is admitted until none can be: kUnsatisfiable, or kUnknown.
SolveStatus WindowSolver::shrink(std::span<const Literal> given, std::vector<std::size_t>& events) {
  for (;;) {
    const auto guard = new_guard();
    std::vector<Literal> more = {guard}, fewer = {~guard};
    std::size_t next = 0;
    for (std::size_t i = 0; i < model_.events.size(); ++i) {
      const bool in = next < events.size() && events[next] == i;
      if (in) ++next;
      (in ? fewer : more).push_back(~event(i));
    }
    solver_->add_clause(fewer);
    const auto status = solve(given, more);
    if (status == SolveStatus::kSatisfiable) events = events_at_hand();
    solver_->add_clause(std::vector{~guard});
    if (status != SolveStatus::kSatisfiable) return status;
  }
}

ListEnd WindowSolver::least_events(std::span<const Literal> given, std::size_t limit,
                                   std::vector<std::vector<std::size_t>>& out) {
  // As a rule nothing has to happen but what is given, and then no other set is least.
  std::vector<Literal> nothing_else;
  for (std::size_t i = 0; i < model_.events.size(); ++i) {
    if (std::find(given.begin(), given.end(), event(i)) == given.end()) {
      nothing_else.push_back(~event(i));
    }
  }
  const auto alone = solve(given, nothing_else);
  if (alone == SolveStatus::kUnknown) return ListEnd::kStopped;
  if (alone == SolveStatus::kSatisfiable) {
    out.push_back(events_at_hand());
    return ListEnd::kComplete;
  }
  const auto guard = new_guard();
  auto end = ListEnd::kComplete;
  for (;;) {
    const auto status = solve(given, std::span(&guard, 1));
    if (status == SolveStatus::kUnsatisfiable) break;
    if (status == SolveStatus::kUnknown || out.size() == limit) {
      end = status == SolveStatus::kUnknown ? ListEnd::kStopped : ListEnd::kTooMany;
      break;
    }
    auto events = events_at_hand();
    if (shrink(given, events) == SolveStatus::kUnknown) {
      end = ListEnd::kStopped;
      break;
    }
    std::vector<Literal> others = {~guard};
    for (const auto i : events) others.push_back(~event(i));
    solver_->add_clause(others);
    out.push_back(std::move(events));
  }
  solver_->add_clause(std::vector{~guard});
  std::sort(out.begin(), out.end());
  return end;
}

}  // namespace parallax::harness
