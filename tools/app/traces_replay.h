#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compiler/base/source_file.h"
#include "tools/app/model_options.h"

namespace parallax::tools {

struct ReplayTracesOptions {
  std::string file;          // --replay
  bool other_model = false;  // --other-model
};

/// Result of replaying one trace of a file.
struct ReplayedTrace {
  std::int64_t number = 0;
  bool agrees = false;
  /// The explored executions of the plan have no such trace, and others may: it neither agrees nor
  /// fails. `reason` says what was not explored.
  bool undecided = false;
  std::int64_t hidden = 0;  // if it agrees: number of atoms with values that it does not mention
  // For one that fails: the first place where it does, why, and the place of the axiom.
  std::int64_t timepoint = 0;
  std::string reason;
  std::optional<base::SourceRange> source;
};

struct ReplayedTraces {
  std::vector<ReplayedTrace> traces;  // in order of the file
  std::int64_t seen = 0, failed = 0, undecided = 0;
  std::int64_t checked = 0;  // agree, and the reference evaluator says so, too
  bool finished = false;     // not stopped before the last one
  bool sound = true;         // solver and evaluator never disagreed
  bool closed = false;       // the file says how its list ended
};

/// `traces --replay`: checks the traces of a file against the model. `report` is called for each as
/// soon as its result is known. Reports those that fail (E7204, E7205) at the first axiom and
/// timepoint; where a plan may have it all the same, as not every execution was explored, a trace
/// is undecided. Every trace that agrees is checked again by the reference evaluator, where the
/// model can be expanded. Files that cannot be read are reported (E61xx).
base::Result<ReplayedTraces> replay_traces(const ModelOptions& model,
                                           const ReplayTracesOptions& options,
                                           const std::function<void(const ReplayedTrace&)>& report,
                                           Context& context);

}  // namespace parallax::tools
