// Two rates from runs with equal starts (McNemar 1947).
//
// The difference of the two rates is P(gained) - P(mended), whatever the runs of a pair have in
// common; pairs with equal results say nothing about it. Given the number of discordant pairs, the
// gained ones among them are binomial with P(gained) / (P(gained) + P(mended)), which is at most
// 1/2 if the rate has not grown. So the test is exact for independent pairs, also for those whose
// starts differ; equal starts make it sharp, as fewer pairs part by chance.

#include "harness/confidence/paired_runs.h"

#include "compiler/base/contract.h"
#include "harness/confidence/clean_runs.h"
#include "harness/confidence/quantiles.h"
#include "harness/confidence/rate_evidence.h"

namespace parallax::harness {

void PairedRuns::add(RunResult before, RunResult after) {
  ++pairs_;
  ++counts_[static_cast<std::size_t>(before)][static_cast<std::size_t>(after)];
}

PairedRuns::Discordant PairedRuns::discordant(RunResult lost_before, RunResult lost_after) const {
  PARALLAX_REQUIRE(lost_before != RunResult::kLost && lost_after != RunResult::kLost,
                   "results that lost runs are taken as");
  constexpr std::array kResults = {RunResult::kClean, RunResult::kFailure, RunResult::kLost};
  Discordant out;
  for (const auto before : kResults) {
    for (const auto after : kResults) {
      const auto count = counts_[static_cast<std::size_t>(before)][static_cast<std::size_t>(after)];
      const auto old = before == RunResult::kLost ? lost_before : before;
      const auto now = after == RunResult::kLost ? lost_after : after;
      if (old == now) continue;
      (now == RunResult::kFailure ? out.gained : out.mended) += count;
    }
  }
  return out;
}

double mcnemar_worse(const PairedRuns& runs) {
  const auto found = runs.discordant(RunResult::kFailure, RunResult::kClean);
  return binomial_at_least(found.gained, found.gained + found.mended, 0.5);
}

double paired_excess_bound(const PairedRuns& runs, double confidence_level) {
  if (runs.pairs() == 0) return 1.0;
  const auto found = runs.discordant(RunResult::kClean, RunResult::kFailure);
  const double level = 1.0 - 0.5 * (1.0 - confidence_level);
  return clopper_pearson_upper(found.gained, runs.pairs(), level) -
         clopper_pearson_lower(found.mended, runs.pairs(), level);
}

}  // namespace parallax::harness
