// Steps of a plan that repeat an attempt and cannot succeed any more.
//
// A step is dead if it can be tried after one of its earlier attempts failed, but can never
// succeed then. `failed at t` is a literal that implies that some earlier attempt failed before
// t; it is built from t - 1 on along the horizon. Two questions decide: can the step be tried at
// some t at which an attempt has failed (it has to be), and can it succeed then (it must not)?
// Implications in one direction are enough, because each question wants its literal true. A
// question that stays open counts against dead.
//
// Cost: two calls for each step with earlier attempts, and for each of them clauses in the
// horizon times the attempts.

#include "runtime/enumerate/dead_steps.h"

#include <optional>

namespace parallax::runtime {
namespace {

using compiler::AtomKind;

/// The question for one step.
class RepeatedStep {
 public:
  RepeatedStep(SolverSession& session, const compiler::AtomIndex& index, std::size_t step,
               const std::vector<std::size_t>& earlier)
      : session_(session), index_(index), step_(step), horizon_(session.model().horizon) {
    follow_failures(earlier);
  }

  bool is_dead() {
    std::vector<Literal> tries;
    std::vector<Literal> successes;
    for (Timepoint t = 1; t < horizon_; ++t) {
      const auto failed = failed_[static_cast<std::size_t>(t)];
      const auto tried = at(AtomKind::kLocation, step_, t);
      const auto succeeded = at(AtomKind::kSucceeded, step_, t + 1);
      if (failed && tried) tries.push_back(both(*failed, *tried));
      if (failed && succeeded) successes.push_back(both(*failed, *succeeded));
    }
    return solve(any(tries)) == SolveStatus::kSatisfiable &&
           solve(any(successes)) == SolveStatus::kUnsatisfiable;
  }

 private:
  std::optional<Literal> at(AtomKind kind, std::size_t step, Timepoint t) const {
    return index_.plan(kind, compiler::PlanStepId(static_cast<std::uint32_t>(step)), t);
  }
  SolveStatus solve(Literal wanted) { return session_.solve(horizon_, std::span(&wanted, 1)); }
  /// A literal that implies one of the others.
  Literal any(std::vector<Literal> literals) {
    const auto out = session_.new_variable();
    literals.push_back(~out);
    session_.add_clause(literals);
    return out;
  }
  /// A literal that implies both.
  Literal both(Literal a, Literal b) {
    const auto out = session_.new_variable();
    session_.add_clause(std::vector{~out, a});
    session_.add_clause(std::vector{~out, b});
    return out;
  }
  /// failed_[t] implies that an earlier attempt failed before t.
  void follow_failures(const std::vector<std::size_t>& earlier) {
    failed_.assign(static_cast<std::size_t>(horizon_) + 1, std::nullopt);
    for (Timepoint t = 1; t <= horizon_; ++t) {
      std::vector<Literal> ways;
      if (const auto before = failed_[static_cast<std::size_t>(t) - 1]) ways.push_back(*before);
      for (const auto attempt : earlier) {
        const auto tried = at(AtomKind::kLocation, attempt, t - 1);
        if (!tried) continue;
        const auto succeeded = at(AtomKind::kSucceeded, attempt, t);
        ways.push_back(succeeded ? both(*tried, ~*succeeded) : *tried);
      }
      if (!ways.empty()) failed_[static_cast<std::size_t>(t)] = any(std::move(ways));
    }
  }

  SolverSession& session_;
  const compiler::AtomIndex& index_;
  std::size_t step_;
  Timepoint horizon_;
  std::vector<std::optional<Literal>> failed_;
};

}  // namespace

std::vector<std::size_t> dead_steps(SolverSession& session,
                                    const std::vector<std::vector<std::size_t>>& earlier) {
  const compiler::AtomIndex index(session.model());
  std::vector<std::size_t> dead;
  for (std::size_t step = 0; step < earlier.size(); ++step) {
    if (earlier[step].empty()) continue;
    if (RepeatedStep(session, index, step, earlier[step]).is_dead()) dead.push_back(step);
  }
  return dead;
}

bool can_fail(SolverSession& session, const std::vector<std::size_t>& steps) {
  const compiler::AtomIndex index(session.model());
  const auto horizon = session.model().horizon;
  std::vector<Literal> ways;
  for (const auto step : steps) {
    const compiler::PlanStepId id(static_cast<std::uint32_t>(step));
    for (Timepoint t = 0; t < horizon; ++t) {
      const auto tried = index.plan(AtomKind::kLocation, id, t);
      if (!tried) continue;
      const auto succeeded = index.plan(AtomKind::kSucceeded, id, t + 1);
      ways.push_back(session.new_variable());
      session.add_clause(std::vector{~ways.back(), *tried});
      if (succeeded) session.add_clause(std::vector{~ways.back(), ~*succeeded});
    }
  }
  if (ways.empty()) return false;
  const auto any = session.new_variable();
  ways.push_back(~any);
  session.add_clause(ways);
  return session.solve(horizon, std::span(&any, 1)) != SolveStatus::kUnsatisfiable;
}

}  // namespace parallax::runtime
