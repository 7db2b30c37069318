#pragma once

#include <optional>
#include <string>

#include "tools/app/explain_sets.h"

namespace parallax::tools {

/// Which axioms are to blame for a discrepancy of a recorded run? The events of its trace and the
/// start are taken as they were, and what was observed at the first divergence; minimal sets of
/// axioms that exclude that are printed. `sample`: TRACE.SAMPLE, or empty for the first
/// discrepancy.
int explain_run(const std::string& run_dir, const std::string& sample, const SetOptions& options,
                Context& context);

}  // namespace parallax::tools
