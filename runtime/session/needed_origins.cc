#include "runtime/session/needed_origins.h"

#include <algorithm>

namespace parallax::runtime {

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

}  // namespace parallax::runtime
