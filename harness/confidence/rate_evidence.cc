// Do counts of failures support or refute a claim about their probability, or a change of it?
//
// For numbers of runs fixed in advance the tests are exact: binomial tails for a claim (Clopper
// and Pearson 1934), the hypergeometric tail for two rates (Fisher's exact test). If the results
// may have decided when to stop, bounds that hold at any time take their place (clean_runs.cc).
// Support needs the bounds of both sides, each at the full level (an intersection-union test);
// refutation takes one of two and so halves the error. Lost runs are counted for whatever makes
// the answer weaker. Numbers of runs that would be enough are found by doubling and bisection.
//
// Cost: some evaluations of an incomplete beta function; Fisher's sum ends where further terms
// change nothing.

#include "harness/confidence/rate_evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/base/contract.h"
#include "harness/confidence/clean_runs.h"
#include "harness/confidence/quantiles.h"

namespace parallax::harness {
namespace {

/// Does this number of failures show that the rate is below the bound?
bool shows_below(std::int64_t failures, const RateCounts& of, double bound, double tail) {
  if (bound >= 1.0) return true;
  return of.fixed ? binomial_at_most(failures, of.runs, bound) <= tail
                  : log_mixture_wealth(failures, of.runs, bound) >= -std::log(tail);
}

bool shows_above(std::int64_t failures, const RateCounts& of, double bound, double tail) {
  if (bound <= 0.0) return true;
  return of.fixed ? binomial_at_least(failures, of.runs, bound) <= tail
                  : shows_below(of.runs - failures, of, 1.0 - bound, tail);
}

/// Bounds of one side; what was lost counts as what widens them.
double upper_bound_of(const RateCounts& counts, double level) {
  const auto bound = counts.fixed ? clopper_pearson_upper : mixture_upper;
  return counts.runs == 0 ? 1.0 : bound(counts.failures + counts.lost, counts.runs, level);
}

double lower_bound_of(const RateCounts& counts, double level) {
  const auto bound = counts.fixed ? clopper_pearson_upper : mixture_upper;
  return counts.runs == 0 ? 0.0 : 1.0 - bound(counts.runs - counts.failures, counts.runs, level);
}

/// The first number from 1 on for which `enough` holds, by doubling and halving: it holds there and
/// not one below.
template <typename Predicate>
std::optional<std::int64_t> first_enough(std::int64_t from, std::int64_t most,
                                         const Predicate& enough) {
  std::int64_t low = from, high = from;
  while (!enough(high)) {
    if (high >= most) return std::nullopt;
    low = high;
    high = std::min(most, 2 * high);
  }
  if (high == from) return high;
  while (high - low > 1) {
    const std::int64_t middle = low + (high - low) / 2;
    (enough(middle) ? high : low) = middle;
  }
  return high;
}

void require_rate_counts(const RateCounts& counts) {
  PARALLAX_REQUIRE(
      counts.failures >= 0 && counts.lost >= 0 && counts.failures + counts.lost <= counts.runs,
      "failures and losses among the runs");
}

}  // namespace

std::string to_string(const RateClaim& claim) {
  if (claim.lower <= 0.0) return fmt::format("below {:.10g} %", 100 * claim.upper);
  if (claim.upper >= 1.0) return fmt::format("above {:.10g} %", 100 * claim.lower);
  return fmt::format("from {:.10g} to {:.10g} %", 100 * claim.lower, 100 * claim.upper);
}

RateVerdict weigh(const RateClaim& claim, const RateCounts& counts) {
  require_rate_counts(counts);
  const double tail = 1.0 - claim.confidence_level;
  const std::int64_t most = counts.failures + counts.lost, least = counts.failures;
  if (shows_below(most, counts, claim.upper, tail) &&
      shows_above(least, counts, claim.lower, tail)) {
    return RateVerdict::kSupports;
  }
  const bool two_sided = claim.lower > 0.0 && claim.upper < 1.0;
  const double share = two_sided ? 0.5 * tail : tail;
  const bool above = claim.upper < 1.0 && shows_above(least, counts, claim.upper, share);
  const bool below = claim.lower > 0.0 && shows_below(most, counts, claim.lower, share);
  return above || below ? RateVerdict::kRefutes : RateVerdict::kTooLittle;
}

bool can_support(const RateClaim& claim, std::int64_t runs, bool fixed) {
  const double tail = 1.0 - claim.confidence_level;
  const RateCounts of{runs, 0, 0, fixed};
  if (!shows_below(0, of, claim.upper, tail)) return false;
  // The most failures that still show the upper bound do most for the lower one.
  std::int64_t low = 0, high = runs + 1;
  while (high - low > 1) {
    const std::int64_t middle = low + (high - low) / 2;
    (shows_below(middle, of, claim.upper, tail) ? low : high) = middle;
  }
  return shows_above(low, of, claim.lower, tail);
}

std::optional<std::int64_t> runs_to_support(const RateClaim& claim, std::int64_t most, bool fixed) {
  return first_enough(1, most, [&](std::int64_t runs) { return can_support(claim, runs, fixed); });
}

std::optional<std::int64_t> runs_to_tell(const RateClaim& claim, const RateCounts& counts,
                                         std::int64_t most) {
  require_rate_counts(counts);
  if (counts.runs == 0) return std::nullopt;
  const auto scaled = [&](std::int64_t count, std::int64_t runs) {
    return std::llround(static_cast<double>(count) * static_cast<double>(runs) /
                        static_cast<double>(counts.runs));
  };
  return first_enough(counts.runs, most, [&](std::int64_t runs) {
    RateCounts more{runs, scaled(counts.failures, runs), 0, counts.fixed};
    more.lost = scaled(counts.failures + counts.lost, runs) - more.failures;
    return weigh(claim, more) != RateVerdict::kTooLittle;
  });
}

double clopper_pearson_lower(std::int64_t failures, std::int64_t runs, double confidence_level) {
  return 1.0 - clopper_pearson_upper(runs - failures, runs, confidence_level);
}

double fisher_worse(const RateCounts& before, const RateCounts& after) {
  require_rate_counts(before);
  require_rate_counts(after);
  PARALLAX_REQUIRE(before.fixed && after.fixed, "numbers of runs that were fixed in advance");
  const std::int64_t old_failures = before.failures + before.lost;
  const std::int64_t failures = old_failures + after.failures;
  const auto log_choose = [](std::int64_t n, std::int64_t k) {
    return -std::log(static_cast<double>(n) + 1.0) -
           log_beta(static_cast<double>(k) + 1.0, static_cast<double>(n - k) + 1.0);
  };
  const double all = log_choose(before.runs + after.runs, failures);
  const std::int64_t least = std::max<std::int64_t>(0, failures - before.runs);
  const std::int64_t most = std::min(failures, after.runs);
  // Away from the most probable number terms fall; the sum ends where further ones change nothing,
  // so that it takes the width of the distribution at most, however many runs there are.
  const auto tail = [&](std::int64_t k, std::int64_t step) {
    constexpr double kNothing = 1e-18;
    double sum = 0.0;
    for (; k >= least && k <= most; k += step) {
      const double term =
          std::exp(log_choose(after.runs, k) + log_choose(before.runs, failures - k) - all);
      sum += term;
      if (term <= kNothing * sum) break;
    }
    return sum;
  };
  const double most_probable = static_cast<double>(failures + 1) *
                               static_cast<double>(after.runs + 1) /
                               static_cast<double>(before.runs + after.runs + 2);
  const bool is_above = static_cast<double>(after.failures) > std::floor(most_probable);
  const double chance = is_above ? tail(after.failures, 1) : 1.0 - tail(after.failures - 1, -1);
  return std::clamp(chance, 0.0, 1.0);
}

bool is_surely_worse(const RateCounts& before, const RateCounts& after, double confidence_level) {
  require_rate_counts(before);
  require_rate_counts(after);
  const double level = 1.0 - 0.5 * (1.0 - confidence_level);
  return lower_bound_of(after, level) > upper_bound_of(before, level);
}

double excess_bound(const RateCounts& before, const RateCounts& after, double confidence_level) {
  require_rate_counts(before);
  require_rate_counts(after);
  const double level = 1.0 - 0.5 * (1.0 - confidence_level);
  return upper_bound_of(after, level) - lower_bound_of(before, level);
}

}  // namespace parallax::harness
