#include "runtime/enumerate/canonical.h"

namespace parallax::runtime {

std::vector<Literal> make_canonical(SolverSession& session, Timepoint n,
                                    std::span<const Literal> assumptions,
                                    std::span<const Literal> order) {
  std::vector<Literal> fixed(assumptions.begin(), assumptions.end());
  for (const auto preferred : order) {
    if (session.value(preferred)) {
      fixed.push_back(preferred);
      continue;
    }
    if (session.is_fixed(~preferred)) {
      fixed.push_back(~preferred);
      continue;
    }
    fixed.push_back(preferred);
    const auto status = session.solve(n, fixed);
    if (status == SolveStatus::kUnknown) return {};
    if (status == SolveStatus::kUnsatisfiable) fixed.back() = ~preferred;
  }
  fixed.erase(fixed.begin(), fixed.begin() + static_cast<std::ptrdiff_t>(assumptions.size()));
  return fixed;
}

}  // namespace parallax::runtime
