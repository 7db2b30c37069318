#include "runtime/session/unsat_core.h"

#include "runtime/session/selected_origins.h"

namespace parallax::runtime {

std::optional<std::vector<std::uint32_t>> find_unsat_core(const compiler::CompiledModel& model,
                                                          compiler::Timepoint n,
                                                          std::unique_ptr<SatSolver> solver) {
  SelectedOrigins selected(model, n, std::move(solver));
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
