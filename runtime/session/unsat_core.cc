#include "runtime/session/unsat_core.h"

#include <algorithm>
#include <utility>

namespace parallax::runtime {

SelectedOrigins::SelectedOrigins(const compiler::CompiledModel& model, compiler::Timepoint n,
                                 std::unique_ptr<SatSolver> solver)
    : solver_(std::move(solver)), first_selector_(model.variable_count() + 1) {
  std::vector<compiler::Literal> clause;
  for (std::size_t i = 0; i < model.clauses.size(); ++i) {
    const auto origin = model.clause_origins[i];
    if (model.clause_timepoints[i] > n) continue;
    if (model.origins[origin].kind == compiler::OriginKind::kInvariant) continue;
    clause.assign(model.clauses[i].begin(), model.clauses[i].end());
    if (!model.clause_is_definition[i]) clause.push_back(~selector(origin));
    solver_->add_clause(clause);
  }
}

SolveStatus SelectedOrigins::solve(std::span<const std::uint32_t> origins) {
  for (const auto origin : origins) solver_->assume(selector(origin));
  return solver_->solve();
}

NeededOrigins shrink_to_needed(SelectedOrigins& selected, std::vector<std::uint32_t> candidates) {
  NeededOrigins result;
  auto& needed = result.origins;
  while (!candidates.empty() && !result.stopped) {
    const auto tried = candidates.back();
    candidates.pop_back();
    auto rest = needed;
    rest.insert(rest.end(), candidates.begin(), candidates.end());
    const auto status = selected.solve(rest);
    if (status == SolveStatus::kUnsatisfiable) {
      selected.keep_failed(candidates);
    } else {
      needed.push_back(tried);
      result.stopped = status == SolveStatus::kUnknown;
    }
  }
  needed.insert(needed.end(), candidates.begin(), candidates.end());
  std::sort(needed.begin(), needed.end());
  return result;
}

UnsatCore find_unsat_core(const compiler::CompiledModel& model, compiler::Timepoint n,
                          std::unique_ptr<SatSolver> solver) {
  SelectedOrigins selected(model, n, std::move(solver));
  std::vector<std::uint32_t> candidates;
  for (std::uint32_t i = 0; i < model.origins.size(); ++i) candidates.push_back(i);
  const auto status = selected.solve(candidates);
  if (status != SolveStatus::kUnsatisfiable) return {status, {}, false};
  selected.keep_failed(candidates);
  auto needed = shrink_to_needed(selected, std::move(candidates));
  return {status, std::move(needed.origins), !needed.stopped};
}

}  // namespace parallax::runtime
