#pragma once

#include "compiler/base/write_gate.h"
#include "tools/repair/proposal.h"

namespace parallax::tools {

/// Writes the files of a proposal. Reports what cannot be written, or must not by the gate, before
/// anything is.
base::Status apply_proposal(const Proposal& proposal, const base::WriteGate& gate,
                            Context& context);

}  // namespace parallax::tools
