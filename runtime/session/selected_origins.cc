#include "runtime/session/selected_origins.h"

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

}  // namespace parallax::runtime
