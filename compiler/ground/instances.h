#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "compiler/ground/formula_grounder.h"

namespace parallax::compiler {

/// Calls `visit` for every assignment of the variables, the last one fastest, each bound in the
/// grounder. Stops when the grounder has failed. An empty domain has no instance.
template <typename Visit>
void for_each_instance(const std::vector<VariableId>& variables, const GroundModel& model,
                       FormulaGrounder& grounder, const Visit& visit) {
  const auto domain = [&](std::size_t i) -> const std::vector<GroundTermId>& {
    return model.universe().domain(model.typed().variables[variables[i]].sort);
  };
  std::vector<std::size_t> odometer(variables.size(), 0);
  std::int64_t instances = 1;
  for (std::size_t i = 0; i < variables.size(); ++i) {
    if (domain(i).empty()) return;
    grounder.bind(variables[i], domain(i)[0]);
    if (__builtin_mul_overflow(instances, static_cast<std::int64_t>(domain(i).size()),
                               &instances)) {
      instances = std::numeric_limits<std::int64_t>::max();
    }
  }
  if (!grounder.spend(instances)) return;
  for (;;) {
    if (!grounder.spend(0)) return;
    visit();
    std::size_t i = variables.size();
    for (;;) {
      if (i == 0 || grounder.failed()) return;
      --i;
      if (++odometer[i] < domain(i).size()) break;
      odometer[i] = 0;
      grounder.bind(variables[i], domain(i)[0]);
    }
    grounder.bind(variables[i], domain(i)[odometer[i]]);
  }
}

}  // namespace parallax::compiler
