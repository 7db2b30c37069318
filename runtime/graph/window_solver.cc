// All answers to a question about a window: valuations of a projection under assumptions, or
// those of them with as few true literals as possible.
//
// Our own search (clause_search.cc) enumerates valuations without blocking clauses, which is
// fastest for many small questions. A question that takes it more than a limited number of
// conflicts starts anew in CaDiCaL, and so do all later ones. There each answer is excluded by a
// clause over the projection; these clauses hang on a guard of the question, which is false
// afterwards. Every answer is evaluated once on all clauses of the window, whoever found it.
//
// Subset-minimal sets of true literals: the search prefers false, so its first valuation is one,
// and the only one if all its true literals are given. Otherwise the solver excludes all
// supersets of the sets that are known. The true literals of each valuation that is left are
// reduced, each time by a clause that one of them is false and an assumption that no other is
// true, until none can be left out. So each set is minimal, and none is missed.
//
// Cost: for each valuation one pass over the clauses, and the search for it; one more search to
// know that there are no others. For each set, except the first, as many calls as literals are
// left out, and two more. There may be exponentially many of both.

#include "runtime/graph/window_solver.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace parallax::runtime {
namespace {

/// A question that meets more conflicts than this is left to the solver, and so are those after it.
constexpr std::int64_t kQueryConflicts = 2000;

/// `target` is a ClauseSearch or a SatSolver.
template <typename Target>
void add_window(const WindowClauses& window, Target& target) {
  std::vector<Literal> clause;
  for (const auto& written : window.clauses) {
    clause.clear();
    for (const auto literal : written) clause.push_back(Literal::from_dimacs(literal));
    target.add_clause(clause);
  }
}

}  // namespace

void assume(std::span<const Literal> literals, const Bits& values, std::vector<Literal>& out) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    out.push_back(values[i] ? literals[i] : ~literals[i]);
  }
}

Move move_of(const LayeredModel& model, const Bits& values) {
  const auto hidden = values.end() - static_cast<std::ptrdiff_t>(model.hidden.size());
  const auto observed = hidden - static_cast<std::ptrdiff_t>(model.observed.size());
  return {Bits(values.begin(), observed), Bits(observed, hidden), Bits(hidden, values.end())};
}

WindowSolver::WindowSolver(const WindowClauses& window, std::vector<Literal> projection,
                           const std::atomic<bool>* stop)
    : window_(window),
      projection_(std::move(projection)),
      stop_(stop),
      search_(window.variables, projection_),
      next_guard_(window.variables + 1) {
  add_window(window, search_);
}

template <typename Value>
Bits WindowSolver::read(const Value& value) const {
  for (const auto& clause : window_.clauses) {
    PARALLAX_REQUIRE(
        std::any_of(clause.begin(), clause.end(),
                    [&](std::int32_t literal) { return value(Literal::from_dimacs(literal)); }),
        "what a window admits satisfies every clause of it");
  }
  Bits out;
  out.reserve(projection_.size());
  for (const auto literal : projection_) out.push_back(value(literal));
  return out;
}

Bits WindowSolver::solver_valuation() const {
  return read([&](Literal literal) { return solver_->value(literal); });
}

WindowSolver::Answer WindowSolver::ask(std::span<const Literal> given, const WindowLimits& limits) {
  if (!search_gave_up_) {
    auto answer = search(given, limits);
    if (answer.end != WindowEnd::kNeedsSolver || !limits.solver) return answer;
    search_gave_up_ = true;
  }
  return solve(given, limits.valuations);
}

WindowSolver::Answer WindowSolver::search(std::span<const Literal> given,
                                          const WindowLimits& limits) {
  Answer answer;
  const auto last = std::min(search_.conflicts() + kQueryConflicts, limits.conflicts);
  search_.begin(given);
  while (true) {
    const auto status = search_.next(last - search_.conflicts());
    if (status == ClauseSearch::Status::kNoMore) return answer;
    if (status == ClauseSearch::Status::kGaveUp) {
      const bool is_spent = search_.conflicts() >= limits.conflicts;
      answer.end = is_spent ? WindowEnd::kSpent : WindowEnd::kNeedsSolver;
      return answer;
    }
    const bool is_stopped = stop_ != nullptr && stop_->load();
    if (is_stopped || answer.found.size() == limits.valuations) {
      answer.end = is_stopped ? WindowEnd::kStopped : WindowEnd::kTooMany;
      return answer;
    }
    answer.found.push_back(read([&](Literal literal) { return search_.value(literal); }));
  }
}

SatSolver& WindowSolver::solver() {
  if (solver_ == nullptr) {
    solver_ = make_cadical_solver(stop_);
    add_window(window_, *solver_);
    for (const auto literal : projection_) solver_->set_phase(~literal);
  }
  return *solver_;
}

SolveStatus WindowSolver::solve_with(std::span<const Literal> given,
                                     std::span<const Literal> more) {
  auto& solver = this->solver();
  for (const auto literal : more) solver.assume(literal);
  for (const auto literal : given) solver.assume(literal);
  return solver.solve();
}

WindowSolver::Answer WindowSolver::solve(std::span<const Literal> given, std::size_t limit) {
  Answer answer;
  const auto guard = new_guard();
  std::vector<Literal> blocking;
  while (true) {
    const auto status = solve_with(given, std::span(&guard, 1));
    if (status == SolveStatus::kUnsatisfiable) break;
    if (status == SolveStatus::kUnknown || answer.found.size() == limit) {
      answer.end = status == SolveStatus::kUnknown ? WindowEnd::kStopped : WindowEnd::kTooMany;
      break;
    }
    const auto& values = answer.found.emplace_back(solver_valuation());
    blocking.clear();
    assume(projection_, values, blocking);
    for (auto& literal : blocking) literal = ~literal;
    blocking.push_back(~guard);
    solver_->add_clause(blocking);
  }
  solver_->add_clause(std::vector{~guard});
  std::sort(answer.found.begin(), answer.found.end());
  return answer;
}

/// Leaves out true literals of a valuation until none can be: kUnsatisfiable, or kUnknown.
SolveStatus WindowSolver::shrink(std::span<const Literal> given, Bits& valuation) {
  while (true) {
    const auto guard = new_guard();
    std::vector<Literal> more = {guard}, fewer = {~guard};
    for (std::size_t i = 0; i < projection_.size(); ++i) {
      (valuation[i] ? fewer : more).push_back(~projection_[i]);
    }
    solver_->add_clause(fewer);
    const auto status = solve_with(given, more);
    if (status == SolveStatus::kSatisfiable) valuation = solver_valuation();
    solver_->add_clause(std::vector{~guard});
    if (status != SolveStatus::kSatisfiable) return status;
  }
}

WindowSolver::Answer WindowSolver::least(std::span<const Literal> given, std::size_t limit) {
  const auto guard = new_guard();
  Answer answer;
  const auto add = [&](Bits valuation) {
    std::vector<Literal> others = {~guard};
    bool is_given = true;
    for (std::size_t i = 0; i < projection_.size(); ++i) {
      if (!valuation[i]) continue;
      others.push_back(~projection_[i]);
      is_given = is_given && std::find(given.begin(), given.end(), projection_[i]) != given.end();
    }
    answer.found.push_back(std::move(valuation));
    if (!is_given) solver().add_clause(others);
    return !is_given;
  };
  if (!search_gave_up_) {
    search_.begin(given);
    const auto status = search_.next(kQueryConflicts);
    if (status == ClauseSearch::Status::kNoMore) return answer;
    search_gave_up_ = status == ClauseSearch::Status::kGaveUp;
    if (status == ClauseSearch::Status::kFound &&
        !add(read([&](Literal literal) { return search_.value(literal); }))) {
      return answer;
    }
  }
  while (true) {
    const auto status = solve_with(given, std::span(&guard, 1));
    if (status == SolveStatus::kUnsatisfiable) break;
    auto valuation = status == SolveStatus::kSatisfiable ? solver_valuation() : Bits();
    const bool is_stopped =
        status == SolveStatus::kUnknown || shrink(given, valuation) == SolveStatus::kUnknown;
    if (is_stopped || answer.found.size() == limit) {
      answer.end = is_stopped ? WindowEnd::kStopped : WindowEnd::kTooMany;
      break;
    }
    if (!add(std::move(valuation))) break;
  }
  solver_->add_clause(std::vector{~guard});
  std::sort(answer.found.begin(), answer.found.end(), std::greater<>());
  return answer;
}

}  // namespace parallax::runtime
