// All answers to a question about a window: valuations of a projection under assumptions.
//
// Our own search (clause_search.cc) enumerates them without blocking clauses, which is fastest
// for many small questions. A question that takes it more than a limited number of conflicts
// starts anew in CaDiCaL, and so do all later ones. There each answer is excluded by a clause
// over the projection; these clauses hang on a guard of the question, which is false afterwards.
// Every answer is evaluated once on all clauses of the window, whoever found it.
//
// Cost: for each answer one pass over the clauses, and what the search for it takes; one more
// search to know that there are no others.

#include "runtime/graph/window_query.h"

#include <algorithm>
#include <utility>

namespace parallax::runtime {
namespace {

/// A question that meets more conflicts than this is left to the solver, and so are those after it.
constexpr std::int64_t kQueryConflicts = 2000;

std::vector<std::vector<Literal>> all_clauses(const WindowClauses& window,
                                              std::vector<std::vector<Literal>> more) {
  auto out = std::move(more);
  for (const auto& written : window.clauses) {
    auto& clause = out.emplace_back();
    for (const auto literal : written) clause.push_back(Literal::from_dimacs(literal));
  }
  return out;
}

}  // namespace

WindowQuery::WindowQuery(const WindowClauses& window, std::vector<std::vector<Literal>> more,
                         std::int32_t variables, std::vector<Literal> projection,
                         const std::atomic<bool>* stop)
    : clauses_(all_clauses(window, std::move(more))),
      variables_(std::max(variables, window.variables)),
      projection_(std::move(projection)),
      stop_(stop),
      search_(variables_, projection_),
      next_guard_(variables_ + 1) {
  for (const auto& clause : clauses_) search_.add_clause(clause);
}

template <typename Value>
std::vector<bool> WindowQuery::read(const Value& value) const {
  // Every answer is evaluated once on the clauses themselves.
  for (const auto& clause : clauses_) {
    PARALLAX_REQUIRE(std::any_of(clause.begin(), clause.end(), value),
                     "what a window admits satisfies every clause of it");
  }
  std::vector<bool> out;
  out.reserve(projection_.size());
  for (const auto literal : projection_) out.push_back(value(literal));
  return out;
}

WindowQuery::Answer WindowQuery::ask(std::span<const Literal> assumptions, std::size_t limit) {
  if (solver_ == nullptr) {
    Answer answer;
    const auto last = search_.conflicts() + kQueryConflicts;
    search_.begin(assumptions);
    while (true) {
      const auto status = search_.next(last - search_.conflicts());
      if (status == ClauseSearch::Status::kNoMore) {
        answer.complete = true;
        return answer;
      }
      if (status == ClauseSearch::Status::kGaveUp) break;
      if (is_stopped() || answer.found.size() == limit) return answer;
      answer.found.push_back(read([&](Literal literal) { return search_.value(literal); }));
    }
    if (is_stopped()) return answer;
    start_solver();
  }
  return solve(assumptions, limit);
}

void WindowQuery::start_solver() {
  solver_ = make_cadical_solver(stop_);
  for (const auto& clause : clauses_) solver_->add_clause(clause);
}

WindowQuery::Answer WindowQuery::solve(std::span<const Literal> assumptions, std::size_t limit) {
  Answer answer;
  const auto guard = Literal::positive(next_guard_++);
  std::vector<Literal> blocking;
  while (true) {
    solver_->assume(guard);
    for (const auto literal : assumptions) solver_->assume(literal);
    const auto status = solver_->solve();
    answer.complete = status == SolveStatus::kUnsatisfiable;
    if (status != SolveStatus::kSatisfiable || answer.found.size() == limit) break;
    answer.found.push_back(read([&](Literal literal) { return solver_->value(literal); }));
    blocking = {~guard};
    for (std::size_t i = 0; i < projection_.size(); ++i) {
      blocking.push_back(answer.found.back()[i] ? ~projection_[i] : projection_[i]);
    }
    solver_->add_clause(blocking);
  }
  solver_->add_clause(std::vector{~guard});
  return answer;
}

}  // namespace parallax::runtime
