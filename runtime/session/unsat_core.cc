#include "runtime/session/unsat_core.h"

namespace parallax::runtime {
namespace {

/// Clauses of one origin hold while its selector is assumed.
class SelectedModel {
 public:
  SelectedModel(const compiler::CompiledModel& model, compiler::Timepoint n,
                std::unique_ptr<SatSolver> solver)
      : solver_(std::move(solver)), first_selector_(model.variable_count() + 1) {
    std::vector<Literal> clause;
    for (std::size_t i = 0; i < model.clauses.size(); ++i) {
      const auto& origin = model.origins[model.clause_origins[i]];
      if (model.clause_timepoints[i] > n || origin.what == compiler::kInvariantOrigin) continue;
      clause.assign(model.clauses[i].begin(), model.clauses[i].end());
      if (!model.clause_is_definition[i]) clause.push_back(~selector(model.clause_origins[i]));
      solver_->add_clause(clause);
    }
  }

  SolveStatus solve(const std::vector<std::uint32_t>& origins) {
    for (const auto origin : origins) solver_->assume(selector(origin));
    return solver_->solve();
  }
  bool failed(std::uint32_t origin) const { return solver_->failed(selector(origin)); }

 private:
  Literal selector(std::uint32_t origin) const {
    return Literal::positive(first_selector_ + static_cast<std::int32_t>(origin));
  }
  std::unique_ptr<SatSolver> solver_;
  std::int32_t first_selector_;
};

}  // namespace

std::optional<std::vector<std::uint32_t>> find_unsat_core(const compiler::CompiledModel& model,
                                                          compiler::Timepoint n,
                                                          std::unique_ptr<SatSolver> solver) {
  SelectedModel selected(model, n, std::move(solver));
  std::vector<std::uint32_t> candidates;
  for (std::uint32_t i = 0; i < model.origins.size(); ++i) candidates.push_back(i);
  const auto shrink_to_failed = [&] {
    std::erase_if(candidates, [&](std::uint32_t origin) { return !selected.failed(origin); });
  };
  if (selected.solve(candidates) != SolveStatus::kUnsatisfiable) return std::nullopt;
  shrink_to_failed();
  // Deletion: a member that is not needed goes, together with all that its absence frees.
  std::vector<std::uint32_t> needed;
  while (!candidates.empty()) {
    const auto tried = candidates.back();
    candidates.pop_back();
    auto rest = needed;
    rest.insert(rest.end(), candidates.begin(), candidates.end());
    if (selected.solve(rest) == SolveStatus::kUnsatisfiable) {
      shrink_to_failed();
    } else {
      needed.push_back(tried);
    }
  }
  return std::vector<std::uint32_t>(needed.rbegin(), needed.rend());
}

}  // namespace parallax::runtime
