#pragma once

#include "tools/repair/proposal.h"

namespace parallax::tools {

/// Proposes edits of the model's text. The grammar is that of compiler/repair; it is searched by
/// the number of edits, first about the steps where runs and model parted. Every proposal was
/// compiled from its text and checked against every run.
FoundProposals model_proposals(const RepairInput& input, Context& context);

}  // namespace parallax::tools
