#include "runtime/session/unsat_core.h"

#include <utility>

#include "runtime/session/needed_origins.h"

namespace parallax::runtime {

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
