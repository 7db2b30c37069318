#include "harness/search/rare_event.h"

#include "compiler/base/contract.h"
#include "harness/search/rare_event_batches.h"

namespace parallax::harness {

std::int64_t least_runs(RareEventMethod method) {
  return method == RareEventMethod::kSplitting ? 3500 : 1000;
}

void count_runs(const std::vector<Evaluation>& evaluations, RareEventResult& result) {
  for (const auto& one : evaluations) {
    const bool invalid = one.kind == EvaluationKind::kInvalid;
    result.invalid += invalid ? 1 : 0;
    result.runs += invalid ? 0 : 1;
    result.lost += one.kind == EvaluationKind::kLost ? 1 : 0;
  }
}

RareEventResult estimate_rare_event(const RareEventOptions& options,
                                    const BatchEvaluator& evaluate) {
  PARALLAX_REQUIRE(options.dimensions > 0 && options.budget >= least_runs(options.method),
                   "something to estimate, and enough runs");
  return options.method == RareEventMethod::kSplitting ? estimate_by_splitting(options, evaluate)
                                                       : estimate_by_importance(options, evaluate);
}

}  // namespace parallax::harness
