#pragma once

#include <cstddef>
#include <vector>

#include "tools/repair/proposal.h"

namespace parallax::tools {

/// Number of repairs of the model, best first, that are taken as assumptions about the world.
inline constexpr std::size_t kMostModels = 3;

/// Proposes edits of the plan after which it avoids a step that went wrong, or goes on after it,
/// and still reaches its goal. `models` are the repairs of the model that were found, best first:
/// each is an assumption about the world; without any, the runs' observations of the step alone
/// count. Every proposal was compiled from its text and checked for executions.
FoundProposals plan_proposals(const RepairInput& input, const std::vector<Proposal>& models,
                              Context& context);

}  // namespace parallax::tools
