#pragma once

#include <atomic>
#include <string>

#include "tools/suite/footprint.h"
#include "tools/suite/suite_runner.h"

namespace parallax::tools {

/// Files of a failing case that have changed since it last passed, and the output of `parallax
/// diff` about the models of then and now: the shortest trace that was lost or gained, the axioms
/// against it, the edit that it depends on. Empty where no pass is known.
std::string since_last_pass(const SuiteCase& one, const RunnerOptions& options,
                            const Footprint& footprint, const std::atomic<bool>& stop);

}  // namespace parallax::tools
