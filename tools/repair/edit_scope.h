#pragma once

#include <cstdint>

#include "compiler/repair/edit_grammar.h"
#include "tools/repair/repair_input.h"

namespace parallax::tools {

/// How far edits go from the steps at which runs and model part.
enum class ScopeReach : std::uint8_t {
  kPartings,      // their events, and the fluents that differed
  kEarlierSteps,  // also the events before, and all fluents
  kWholeRuns,     // all events of the runs, and all fluents
};

/// The steps at which the runs of `input` and its model part, and what the runs tell about events,
/// as the scope of edits. Cost: linear in the runs.
compiler::EditScope edit_scope(const RepairInput& input, ScopeReach reach);

}  // namespace parallax::tools
