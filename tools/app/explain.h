#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/artifact/compiled_model.h"
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

/// Which axioms are to blame for a discrepancy of a recorded run? The events of its trace and the
/// start are taken as they were, and what was observed at the first divergence; minimal sets of
/// axioms that exclude that are printed. `sample`: TRACE.SAMPLE, or empty for the first
/// discrepancy.
int explain_run(const std::string& run_dir, const std::string& sample, const SetOptions& options,
                Context& context);

struct WhyCommand {
  std::string fact;        // `HoldsAt(F,3)`, `!HoldsAt(F(a),3)`, `Happens(E(),2)`
  std::int64_t trace = 1;  // its number in the list of traces
  bool all = false;        // tell further causes as well
};

/// Tells the chain of facts behind one fact of a trace. Reports kNoSuchFact and kNoSuchTrace.
int explain_why(const compiler::CompiledModel& model, const WhyCommand& command, Context& context);

}  // namespace parallax::tools
