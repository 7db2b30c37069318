#pragma once

#include <vector>

#include "harness/search/rare_event.h"

namespace parallax::harness {

/// The evaluator of both methods, with counts, and an end where hardly any start is valid.
class RareEventBatches {
 public:
  RareEventBatches(const BatchEvaluator& evaluate, RareEventResult& result)
      : evaluate_(evaluate), result_(result) {}

  /// False: it ended (`result.end` says why).
  bool run(const std::vector<UnitPoint>& points, std::vector<Evaluation>& answers) {
    auto got = evaluate_(points);
    if (!got) {
      result_.end = RareEventEnd::kStopped;
      return false;
    }
    for (const auto& one : *got) {
      const bool invalid = one.kind == EvaluationKind::kInvalid;
      invalid_in_a_row_ = invalid ? invalid_in_a_row_ + 1 : 0;
    }
    count_runs(*got, result_);
    answers = std::move(*got);
    if (invalid_in_a_row_ < kMostInvalid) return true;
    result_.end = RareEventEnd::kInvalid;
    return false;
  }

 private:
  static constexpr std::int64_t kMostInvalid = 10'000;
  const BatchEvaluator& evaluate_;
  RareEventResult& result_;
  std::int64_t invalid_in_a_row_ = 0;
};

RareEventResult estimate_by_importance(const RareEventOptions& options,
                                       const BatchEvaluator& evaluate);
RareEventResult estimate_by_splitting(const RareEventOptions& options,
                                      const BatchEvaluator& evaluate);

}  // namespace parallax::harness
