#pragma once

#include "tools/repair/proposal.h"

namespace parallax::tools {

/// Writes the files of a proposal. Reports what cannot be written, before anything is.
base::Status apply_proposal(const Proposal& proposal, Context& context);

}  // namespace parallax::tools
