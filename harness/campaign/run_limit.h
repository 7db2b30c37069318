#pragma once

#include <cstdint>

#include "compiler/base/diagnostic.h"
#include "harness/config/scenario.h"

namespace parallax::harness {

/// How many simulations a trace may take, and how many the criterion asks for if all are clean.
struct RunLimit {
  std::int64_t max_runs = 0;
  std::int64_t needed = 0;  // 0: it cannot tell
};

/// `limits: max_runs`, or twice what the criterion needs and at least 300 where none is given: room
/// for a lost run, after which more are needed.
RunLimit run_limit(const Scenario& scenario);

/// Reports kRunLimitTooLow where the criterion can never be met, at the scenario's number unless
/// another one took its place.
void warn_of_low_limit(const Scenario& scenario, const base::SourceFiles& files,
                       base::DiagnosticSink& sink);

}  // namespace parallax::harness
