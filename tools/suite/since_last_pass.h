#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "tools/suite/footprint.h"
#include "tools/suite/last_pass.h"
#include "tools/suite/suite_runner.h"

namespace parallax::tools {

/// Files of a failing case that have changed since it last passed, and the output of `parallax
/// diff` about the models of then and now: the shortest trace that was lost or gained, the axioms
/// against it, the edit that it depends on. Empty where no pass is known.
std::string since_last_pass(const SuiteCase& one, const RunnerOptions& options,
                            const Footprint& footprint, const std::atomic<bool>& stop);

/// What changed in the files of a case by value, a line each ("world.bodies.box.mass_kg 0.3 -> 3"):
/// settings, declarations and axioms, and forms of the plan, without solving anything.
std::vector<std::string> changed_values(const SuiteCase& one, const LastPass& before,
                                        const CaseResult& result, const RunnerOptions& options,
                                        const std::atomic<bool>& stop);

}  // namespace parallax::tools
