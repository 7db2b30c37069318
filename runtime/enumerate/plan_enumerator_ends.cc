// How the executions that a list of traces leaves out end: at a cut of the plan, or at the horizon.

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "runtime/enumerate/plan_enumerator.h"

namespace parallax::runtime {

/// Notes the cuts to which an execution comes by `n` without having met the constraints. It is
/// asked of prefixes that the model without its plan can continue, as for traces: nothing is known
/// of the plan behind a cut. False, and done: the solver was stopped.
bool PlanEnumerator::note_cuts(Timepoint n) {
  std::vector<std::pair<std::size_t, Literal>> open;
  for (std::size_t cut = 0; cut < session_->model().plan_cuts.size(); ++cut) {
    if (contains(cuts_, cut)) continue;
    const auto there = index_.at(compiler::PlanCutId(static_cast<std::uint32_t>(cut)), n);
    if (there) open.emplace_back(cut, *there);
  }
  auto status = SolveStatus::kSatisfiable;
  while (!open.empty() && status == SolveStatus::kSatisfiable) {
    const auto wanted = session_->new_variable();
    std::vector<Literal> clause = {~wanted};
    for (const auto& [cut, there] : open) clause.push_back(there);
    session_->add_clause(clause);
    auto assumptions = no_hit_until(n);
    assumptions.push_back(wanted);
    status = session_->solve_whole(n, assumptions);
    if (status == SolveStatus::kSatisfiable) {
      std::erase_if(open, [&](const auto& entry) {
        if (!session_->value(entry.second)) return false;
        cuts_.push_back(entry.first);
        return true;
      });
    }
    const auto retired = ~wanted;
    session_->add_clause(std::span(&retired, 1));
  }
  std::sort(cuts_.begin(), cuts_.end());
  done_ = done_ || status == SolveStatus::kUnknown;
  return status != SolveStatus::kUnknown;
}

/// Is there an execution that never meets the constraints and goes on beyond the horizon, or behind
/// a cut?
void PlanEnumerator::finish() {
  done_ = true;
  const auto unmet = no_hit_until(n_);
  const auto running = index_.running(n_);
  auto going_on = unmet;
  if (running) going_on.push_back(*running);
  std::optional<Literal> broken;
  if (breaker_) {
    broken = breaker_->assumption();
    going_on.push_back(*broken);
  }
  switch (session_->solve(n_, going_on)) {
    case SolveStatus::kUnsatisfiable:
      note_refuted(broken);
      open_ends_.cuts = cuts_;
      exploration_ =
          cuts_.empty() ? Exploration::kAllTracesExplored : Exploration::kCompleteUpToBound;
      break;
    case SolveStatus::kSatisfiable:
      if (!running || find_step(unmet) != SolveStatus::kUnknown) {
        open_ends_.cuts = cuts_;
        exploration_ = Exploration::kCompleteUpToBound;
      } else {
        open_ends_ = {};  // half of them would say that there are no others
      }
      break;
    case SolveStatus::kUnknown:
      break;
  }
}

/// The first step at which some execution stands at the horizon.
SolveStatus PlanEnumerator::find_step(std::span<const Literal> unmet) {
  std::vector<std::pair<std::size_t, Literal>> steps;
  for (std::size_t step = 0; step < session_->model().plan.size(); ++step) {
    const auto there = index_.at(compiler::PlanStepId(static_cast<std::uint32_t>(step)), n_);
    if (there) steps.emplace_back(step, *there);
  }
  for (;;) {
    const auto wanted = session_->new_variable();
    std::vector<Literal> clause = {~wanted};
    for (const auto& [step, there] : steps) clause.push_back(there);
    session_->add_clause(clause);
    std::vector<Literal> assumptions(unmet.begin(), unmet.end());
    assumptions.push_back(wanted);
    const auto status = session_->solve(n_, assumptions);
    const auto retired = ~wanted;
    session_->add_clause(std::span(&retired, 1));
    if (status == SolveStatus::kUnknown) return status;
    if (status == SolveStatus::kUnsatisfiable) break;
    // Whatever step the solver came upon: is there an earlier one?
    const auto found = std::find_if(steps.begin(), steps.end(), [&](const auto& entry) {
      return session_->value(entry.second);
    });
    open_ends_.step = found->first;
    steps.erase(found, steps.end());
  }
  return open_ends_.step ? SolveStatus::kSatisfiable : SolveStatus::kUnsatisfiable;
}

}  // namespace parallax::runtime
