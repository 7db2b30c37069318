#pragma once

#include <cstddef>
#include <vector>

#include "tools/repair/proposal.h"

namespace parallax::tools {

/// What the ranking left out.
struct Unranked {
  bool more = false;             // there were more
  std::size_t not_compared = 0;  // of them were as likely as the first, before traces were compared
};

/// Puts proposals in order, best first, and finds out what they do to the traces. Leaves at most
/// `limit` (0: all) of them. Those that the order cannot tell apart are tied.
Unranked rank_proposals(const RepairInput& input, std::size_t limit,
                        std::vector<Proposal>& proposals, Context& context);

/// So many of the ranked proposals, from the first one on, are of one rank.
std::size_t of_first_rank(const std::vector<Proposal>& proposals);

/// Those that the runs speak for as much as for the first one, whatever is usual; indices.
std::vector<std::size_t> as_well_founded(const std::vector<Proposal>& proposals);

}  // namespace parallax::tools
