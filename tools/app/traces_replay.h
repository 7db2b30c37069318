#pragma once

#include <string>

#include "tools/app/model_options.h"

namespace parallax::tools {

struct ReplayTracesOptions {
  std::string file;          // --replay
  bool other_model = false;  // --other-model
};

/// `traces --replay`: holds the traces of a file against the model. Prints a line for each trace
/// and reports those that fail (E7204, E7205) at the first axiom and timepoint. Every trace that
/// agrees is checked again by the reference evaluator, where the model can be expanded. The exit
/// code: 1 if a trace fails, 4 if the run was stopped before the last one; files that cannot be
/// read are reported (E61xx).
int replay_traces(const ModelOptions& model, const ReplayTracesOptions& options, Context& context);

}  // namespace parallax::tools
