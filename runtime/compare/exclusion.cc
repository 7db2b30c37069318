#include "runtime/compare/exclusion.h"

#include <algorithm>
#include <memory>

#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {
namespace {

/// The model with a selector for each origin, and the observation.
class SelectedOrigins {
 public:
  SelectedOrigins(const compiler::CompiledModel& model, compiler::Timepoint by,
                  std::span<const Literal> observation, const std::atomic<bool>* stop)
      : solver_(make_cadical_solver(stop)), first_selector_(model.variable_count() + 1) {
    std::vector<Literal> clause;
    for (std::size_t i = 0; i < model.clauses.size(); ++i) {
      const auto origin = model.clause_origins[i];
      if (model.clause_timepoints[i] > by) continue;
      if (model.origins[origin].what == compiler::kInvariantOrigin) continue;
      clause.assign(model.clauses[i].begin(), model.clauses[i].end());
      if (!model.clause_is_definition[i]) clause.push_back(~selector(origin));
      solver_->add_clause(clause);
    }
    for (const auto literal : observation) solver_->add_clause(std::span(&literal, 1));
  }

  SolveStatus solve(std::span<const std::uint32_t> origins) {
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

std::vector<std::uint32_t> excluding_origins(const compiler::CompiledModel& model,
                                             compiler::Timepoint by,
                                             std::span<const Literal> observation,
                                             const std::function<bool(std::uint32_t)>& dispensable,
                                             const std::atomic<bool>* stop) {
  SelectedOrigins selected(model, by, observation, stop);
  // Candidates are tried from the end.
  std::vector<std::uint32_t> candidates;
  for (const bool last : {false, true}) {
    for (std::uint32_t i = 0; i < model.origins.size(); ++i) {
      if (dispensable(i) == last) candidates.push_back(i);
    }
  }
  if (selected.solve(candidates) != SolveStatus::kUnsatisfiable) return {};
  std::vector<std::uint32_t> needed;
  while (!candidates.empty()) {
    const auto tried = candidates.back();
    candidates.pop_back();
    auto rest = needed;
    rest.insert(rest.end(), candidates.begin(), candidates.end());
    const auto status = selected.solve(rest);
    if (status == SolveStatus::kUnknown) return {};
    if (status == SolveStatus::kSatisfiable) {
      needed.push_back(tried);
    } else {
      std::erase_if(candidates, [&](std::uint32_t origin) { return !selected.failed(origin); });
    }
  }
  std::sort(needed.begin(), needed.end());
  return needed;
}

}  // namespace parallax::runtime
