#include "harness/search/search_history.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "compiler/base/contract.h"

namespace parallax::harness {

void SearchHistory::add(Evaluation evaluation) {
  PARALLAX_REQUIRE(evaluation.point.size() == dimensions_, "a point of the search's dimension");
  const auto number = all_.size();
  const bool observed =
      evaluation.kind == EvaluationKind::kClean || evaluation.kind == EvaluationKind::kDiscrepancy;
  if (evaluation.kind == EvaluationKind::kInvalid) ++invalid_;
  if (observed && std::isfinite(evaluation.margin)) {
    judged_.push_back(number);
    if (best_) {
      const double least = all_[*best_].margin;
      flat_ = flat_ && evaluation.margin == least;
      if (evaluation.margin < least) best_ = number;
    } else {
      best_ = number;
    }
  }
  all_.push_back(std::move(evaluation));
  if (judged_.empty() || judged_.back() != number) return;
  const auto behind =
      std::upper_bound(leading_.begin(), leading_.end(), number,
                       [&](auto a, auto b) { return all_[a].margin < all_[b].margin; });
  leading_.insert(behind, number);
  if (leading_.size() > kLeading) leading_.pop_back();
}

double SearchHistory::validity(const UnitPoint& point) const {
  if (invalid_ == 0) return 1.0;
  // Kernel regression of "was valid", as wide as a tenth of the cube's diagonal, with a prior
  // weight, so that one invalid neighbour does not forbid a place.
  const double width = 0.01 * static_cast<double>(dimensions_);
  double valid = 0.5, all = 0.5;
  for (const auto& evaluation : all_) {
    const double weight = std::exp(-0.5 * squared_distance(point, evaluation.point) / width);
    all += weight;
    if (evaluation.kind != EvaluationKind::kInvalid) valid += weight;
  }
  return valid / all;
}

double squared_distance(const UnitPoint& a, const UnitPoint& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

}  // namespace parallax::harness
