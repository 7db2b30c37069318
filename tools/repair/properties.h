#pragma once

#include <vector>

#include "tools/repair/proposal.h"

namespace parallax::tools {

/// Which of the properties that were asked about every proposal breaks or restores: is there an
/// execution of the plan up to the horizon that violates it? A change of the plan is held against
/// them in the model under which it was found. `proposals` are in the order of their numbers.
/// Reports a property that is none.
base::Status hold_against_properties(const RepairInput& input, std::vector<Proposal>& proposals,
                                     Context& context);

}  // namespace parallax::tools
