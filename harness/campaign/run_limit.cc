#include "harness/campaign/run_limit.h"

#include <algorithm>
#include <string>

#include "compiler/base/diagnostic_codes.h"
#include "harness/confidence/clean_runs.h"

namespace parallax::harness {
namespace {

constexpr std::int64_t kLeastRunLimit = 300;

}  // namespace

RunLimit run_limit(const Scenario& scenario) {
  const auto& criterion = scenario.criterion;
  RunLimit limit{scenario.limits.max_runs, 0};
  if (criterion.kind == CriterionKind::kCleanRuns) {
    limit.needed = runs_needed(criterion.confidence_level, criterion.epsilon);
  }
  if (limit.max_runs == 0) limit.max_runs = std::max(kLeastRunLimit, 2 * limit.needed);
  return limit;
}

void warn_of_low_limit(const Scenario& scenario, const base::SourceFiles& files,
                       base::DiagnosticSink& sink) {
  const auto limit = run_limit(scenario);
  if (limit.max_runs >= limit.needed) return;
  const auto& source = scenario.limits.max_runs_source;
  const bool written = source && files.text(*source) == std::to_string(limit.max_runs);
  sink.warning(base::DiagnosticCode::kRunLimitTooLow,
               written ? *source : base::SourceRange{scenario.source, 0, 0}, limit.max_runs,
               limit.needed);
}

}  // namespace parallax::harness
