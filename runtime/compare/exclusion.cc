#include "runtime/compare/exclusion.h"

#include <algorithm>

#include "runtime/session/selected_origins.h"

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
