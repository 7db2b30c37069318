#pragma once

#include <vector>

#include "tools/repair/proposal.h"

namespace parallax::tools {

/// Checks which of the requested properties each proposal breaks or restores: is there an execution
/// of the plan up to the horizon that violates it? A change of the plan is checked in the model
/// under which it was found. `proposals` are in the order of their numbers. Reports a text that is
/// not a property.
base::Status hold_against_properties(const RepairInput& input, std::vector<Proposal>& proposals,
                                     Context& context);

}  // namespace parallax::tools
