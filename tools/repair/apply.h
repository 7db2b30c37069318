#pragma once

#include "compiler/base/write_gate.h"
#include "tools/repair/proposal.h"

namespace parallax::tools {

/// Writes the files of a proposal. Files that cannot be written, or that the gate forbids, are
/// reported before anything is written.
base::Status apply_proposal(const Proposal& proposal, const base::WriteGate& gate,
                            Context& context);

}  // namespace parallax::tools
