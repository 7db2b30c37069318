#pragma once

#include <cstddef>
#include <vector>

#include "tools/repair/proposal.h"

namespace parallax::tools {

/// Proposals that the ranking left out.
struct Unranked {
  bool more = false;           // there were more
  std::size_t agree_less = 0;  // none agrees with as many runs as the unchanged model: no proposals
  std::size_t not_compared = 0;  // of them were as likely as the first, before traces were compared
};

/// Sorts proposals, best first. Leaves at most `limit` (0: all) of them. Those that the order
/// cannot distinguish are tied. Of proposals that are equal but for their effects on the traces
/// these are computed.
Unranked rank_proposals(const RepairInput& input, std::size_t limit,
                        std::vector<Proposal>& proposals, Context& context);

/// Computes the effects on the traces where they are not known yet.
void compare_traces(const RepairInput& input, std::vector<Proposal>& proposals, Context& context);

/// Number of ranked proposals, from the first one on, that are tied for the first rank.
std::size_t of_first_rank(const std::vector<Proposal>& proposals);

/// Indices of the proposals that the runs support as much as the first one, regardless of size and
/// oddity.
std::vector<std::size_t> as_well_founded(const std::vector<Proposal>& proposals);

}  // namespace parallax::tools
