#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/explain/group_solver.h"
#include "tools/app/context.h"

namespace parallax::tools {

struct SetOptions {
  bool all = false;        // all minimal sets, not only a smallest one
  std::int64_t limit = 0;  // of --all; 0: no limit
};

/// What a simulation showed, for the axioms to be held against.
struct ObservedRun {
  runtime::Observed observed;
  std::vector<std::string> lines;  // how it is told: "RobotAt(bTable) does not hold at 6"
};

/// Why has the model no trace? Prints minimal sets of axioms that contradict each other, with the
/// ground instances that take part, or that there is no contradiction. The exit code: 1 if there is
/// one. Reports kExplanationCutShort if the search was stopped, kProofRejected if the checker does
/// not follow the solver.
/// With `run`: none that is like it.
int explain_sets(const compiler::CompiledModel& model, const SetOptions& options,
                 const std::optional<ObservedRun>& run, Context& context);

}  // namespace parallax::tools
