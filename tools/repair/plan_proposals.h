#pragma once

#include <cstddef>
#include <vector>

#include "tools/repair/proposal.h"

namespace parallax::tools {

/// So many repairs of the model, the best ones, are taken for how the world may be.
inline constexpr std::size_t kMostModels = 3;

/// Edits of the plan after which it does not come any more to a step that went wrong, or goes on
/// behind it, and still gets where it got. `models` are the repairs of the model that were found,
/// best first: each says in its own way how the world is; without any, what the runs have shown of
/// the step by itself counts. Every proposal was compiled from its text and asked for executions.
FoundProposals plan_proposals(const RepairInput& input, const std::vector<Proposal>& models,
                              Context& context);

}  // namespace parallax::tools
