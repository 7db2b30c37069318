#include "runtime/compare/exclusion.h"

#include <utility>

#include "runtime/session/needed_origins.h"

namespace parallax::runtime {

std::vector<std::uint32_t> excluding_origins(const compiler::CompiledModel& model,
                                             compiler::Timepoint by,
                                             std::span<const Literal> observation,
                                             const std::function<bool(std::uint32_t)>& dispensable,
                                             const std::atomic<bool>* stop) {
  SelectedOrigins selected(model, by, make_cadical_solver(stop));
  for (const auto literal : observation) selected.require(literal);
  // Candidates are tried from the end.
  std::vector<std::uint32_t> candidates;
  for (const bool last : {false, true}) {
    for (std::uint32_t i = 0; i < model.origins.size(); ++i) {
      if (dispensable(i) == last) candidates.push_back(i);
    }
  }
  if (selected.solve(candidates) != SolveStatus::kUnsatisfiable) return {};
  auto needed = shrink_to_needed(selected, std::move(candidates));
  if (needed.stopped) return {};
  return std::move(needed.origins);
}

}  // namespace parallax::runtime
