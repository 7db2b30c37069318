// The sequential probability ratio test (Wald 1945), as statistical model checkers use it with an
// indifference region (Younes and Simmons 2002).
//
// After k failures in n runs the log likelihood ratio of p = upper to p = lower is
//   S = k ln(upper / lower) + (n - k) ln((1 - upper) / (1 - lower)).
// The runs end where S leaves (-ln(1/error), ln(1/error)). At p = upper exp(-S) is a martingale
// that begins at 1, so by Ville's inequality it ever reaches 1/error with a probability of at most
// the error; beyond upper this is still less probable. The other side is its mirror image. Wald's
// boundaries ln((1 - error) / error) are a little nearer, and promise the sum of both errors only.
//
// Lost runs: S grows with each failure, so the walk of any results of the lost runs lies between
// those with all of them failures and all of them clean. If the upper walk first leaves below,
// every walk does so by then; likewise above. If the upper leaves above and the lower one below,
// what was lost decides.

#include "harness/confidence/sequential_test.h"

#include <cmath>

#include "compiler/base/contract.h"

namespace parallax::harness {

SequentialTest::SequentialTest(const IndifferenceRegion& region)
    : failure_step_(std::log(region.upper / region.lower)),
      clean_step_(std::log1p(-region.upper) - std::log1p(-region.lower)),
      boundary_(-std::log1p(-region.confidence_level)) {
  PARALLAX_REQUIRE(region.lower > 0.0 && region.lower < region.upper && region.upper < 1.0,
                   "0 < lower < upper < 1");
  PARALLAX_REQUIRE(region.confidence_level > 0.0 && region.confidence_level < 1.0,
                   "a confidence in (0, 1)");
}

void SequentialTest::count(Walk& walk, bool failed) const {
  if (failed) ++walk.failures;
  if (walk.answer != SequentialAnswer::kOpen) return;
  // From the counts, so that no rounding adds up over many runs.
  const double log_ratio = static_cast<double>(walk.failures) * failure_step_ +
                           static_cast<double>(runs_ - walk.failures) * clean_step_;
  if (log_ratio <= -boundary_) walk.answer = SequentialAnswer::kBelow;
  if (log_ratio >= boundary_) walk.answer = SequentialAnswer::kAbove;
}

void SequentialTest::add(RunResult result) {
  ++runs_;
  count(most_, result != RunResult::kClean);
  count(least_, result == RunResult::kFailure);
}

SequentialAnswer SequentialTest::answer() const {
  if (most_.answer == SequentialAnswer::kBelow) return SequentialAnswer::kBelow;
  if (least_.answer == SequentialAnswer::kAbove) return SequentialAnswer::kAbove;
  const bool torn =
      most_.answer == SequentialAnswer::kAbove && least_.answer == SequentialAnswer::kBelow;
  return torn ? SequentialAnswer::kUnsettled : SequentialAnswer::kOpen;
}

}  // namespace parallax::harness
