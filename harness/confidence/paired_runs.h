#pragma once

#include <array>
#include <cstdint>

#include "harness/confidence/run_result.h"

namespace parallax::harness {

/// Runs before and after a change, paired by their sample numbers. Pairs are independent of each
/// other; the two runs of a pair may depend on each other, as with equal starts.
class PairedRuns {
 public:
  void add(RunResult before, RunResult after);

  /// Pairs that part.
  struct Discordant {
    std::int64_t gained = 0;  // clean before, failed after
    std::int64_t mended = 0;  // failed before, clean after
  };
  /// With lost runs taken as these results, neither of which is kLost.
  Discordant discordant(RunResult lost_before, RunResult lost_after) const;
  std::int64_t pairs() const { return pairs_; }

 private:
  std::int64_t pairs_ = 0;
  std::array<std::array<std::int64_t, 3>, 3> counts_{};  // by result before, after
};

/// Are failures more probable after than before? McNemar's exact test, of one side: the probability
/// that as many of the discordant pairs are gained failures if both directions are equally
/// probable. Lost runs are taken as failures before and as clean after, so that what is found is
/// found in any case. The number of pairs was fixed.
double mcnemar_worse(const PairedRuns& runs);

/// With this confidence, the probability after exceeds that before by less than this: the upper
/// bound of gained failures less the lower one of mended ones, each at 1 - (1-C)/2 (Clopper and
/// Pearson). Lost runs are taken as clean before and as failures after.
double paired_excess_bound(const PairedRuns& runs, double confidence_level);

}  // namespace parallax::harness
