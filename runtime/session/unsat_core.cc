#include "runtime/session/unsat_core.h"

#include <utility>

#include "runtime/session/needed_origins.h"

namespace parallax::runtime {

std::optional<std::vector<std::uint32_t>> find_unsat_core(const compiler::CompiledModel& model,
                                                          compiler::Timepoint n,
                                                          std::unique_ptr<SatSolver> solver) {
  SelectedOrigins selected(model, n, std::move(solver));
  std::vector<std::uint32_t> candidates;
  for (std::uint32_t i = 0; i < model.origins.size(); ++i) candidates.push_back(i);
  if (selected.solve(candidates) != SolveStatus::kUnsatisfiable) return std::nullopt;
  selected.keep_failed(candidates);
  return shrink_to_needed(selected, std::move(candidates)).origins;
}

}  // namespace parallax::runtime
