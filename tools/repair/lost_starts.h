#pragma once

#include <atomic>
#include <cstddef>
#include <string>

#include "compiler/artifact/compiled_model.h"

namespace parallax::tools {

/// Initial states from which the constraints of a scenario can be reached in one model and not in
/// another.
struct LostStarts {
  std::size_t lost = 0, of = 0;
  bool more = false;  // there are further ones that were not examined
  std::string first;  // of those that are lost: what holds there
};

/// Both models have constraints. Two states are the same if the fluents that both models know
/// agree. Cost: a solver call for each state and length, for 200 states at most.
LostStarts lost_starts(const compiler::CompiledModel& before, const compiler::CompiledModel& after,
                       const std::atomic<bool>& stop);

}  // namespace parallax::tools
