#include "runtime/explain/group_solver.h"

#include <utility>

namespace parallax::runtime {

GroupSolver::GroupSolver(std::int32_t variables, std::size_t groups,
                         std::unique_ptr<SatSolver> solver)
    : solver_(std::move(solver)), variables_(variables), groups_(groups) {
  // Groups that are not asked for are switched on where that costs nothing.
  for (std::uint32_t g = 0; g < groups; ++g) solver_->set_phase(selector(g));
}

void GroupSolver::add(std::span<const Literal> clause, std::uint32_t group) {
  clause_.assign(clause.begin(), clause.end());
  clause_.push_back(~selector(group));
  solver_->add_clause(clause_);
}

SolveStatus GroupSolver::solve(const IndexSet& groups, Effort* effort) {
  asked_ = groups;
  for (const auto group : groups) solver_->assume(selector(group));
  if (effort == nullptr) return solver_->solve();
  const auto before = solver_->conflicts();
  solver_->limit_conflicts(effort->share());
  const auto status = solver_->solve();
  effort->spend(solver_->conflicts() - before);
  return status;
}

IndexSet GroupSolver::core() const {
  IndexSet used;
  for (const auto group : asked_) {
    if (solver_->failed(selector(group))) used.push_back(group);
  }
  return used;
}

IndexSet GroupSolver::satisfied() const {
  IndexSet holding;
  for (std::uint32_t g = 0; g < groups_; ++g) {
    if (solver_->value(selector(g))) holding.push_back(g);
  }
  return holding;
}

GroupSolver load_axioms(ExecutionFormula& formula, const AxiomGroups& groups,
                        std::unique_ptr<SatSolver> fresh) {
  const auto& model = formula.model();
  GroupSolver solver(formula.variables(), groups.size(), std::move(fresh));
  formula.for_each_always([&](std::span<const Literal> clause) { solver.add_definition(clause); });
  for (std::size_t i = 0; i < model.clauses.size(); ++i) {
    const auto group = groups.group_of[model.clause_origins[i]];
    if (formula.is_definition(i) || group == AxiomGroups::kNone) continue;
    solver.add(formula.clause(i), group);
  }
  return solver;
}

}  // namespace parallax::runtime
