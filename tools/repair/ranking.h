#pragma once

#include <cstddef>
#include <vector>

#include "tools/repair/proposal.h"

namespace parallax::tools {

/// Puts proposals in order, best first, and finds out what they do to the traces. Leaves at most
/// `limit` (0: all) of them; true if there were more. Those that the order cannot tell apart are
/// tied.
bool rank_proposals(const RepairInput& input, std::size_t limit, std::vector<Proposal>& proposals,
                    Context& context);

}  // namespace parallax::tools
