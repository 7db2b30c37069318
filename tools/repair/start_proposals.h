#pragma once

#include "tools/repair/proposal.h"

namespace parallax::tools {

/// Changes of what the model says of timepoint 0, or of its formulas about states, after which its
/// starts are starts of the world. Only where `input.start` says that they are not.
FoundProposals start_proposals(const RepairInput& input, Context& context);

}  // namespace parallax::tools
