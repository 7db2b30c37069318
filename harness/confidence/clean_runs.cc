// Bounds on the probability that a run fails.
//
// Clean runs alone: if p is the probability, n clean runs have probability (1-p)^n, so p >=
// epsilon is excluded with confidence C after ln(1-C) / ln(1-epsilon) of them. With failures,
// watched after every run: the wealth of a uniform mixture of bets against "p >= epsilon" has
// expectation 1 at most, so it ever reaches 1/(1-C) with probability 1-C at most (Ville 1939).
// The mixture's integral is an incomplete beta function; its continued fraction is used where
// the powers in front of it cancel. With a number of runs fixed in advance: Clopper and Pearson
// (1934), a quantile of the beta law.
//
// The wealth grows with epsilon, so bounds and numbers of runs are found by bisection, bounds
// down to neighbouring numbers.

#include "harness/confidence/clean_runs.h"

#include <cmath>

#include "compiler/base/contract.h"
#include "harness/confidence/quantiles.h"

namespace parallax::harness {
namespace {

void require_level(double confidence_level) {
  PARALLAX_REQUIRE(confidence_level > 0.0 && confidence_level < 1.0, "a confidence in (0, 1)");
}

void require_counts(std::int64_t failures, std::int64_t runs) {
  PARALLAX_REQUIRE(failures >= 0 && failures <= runs, "failures among the runs");
}

}  // namespace

std::int64_t runs_needed(double confidence_level, double epsilon) {
  require_level(confidence_level);
  PARALLAX_REQUIRE(epsilon > 0.0 && epsilon < 1.0, "a probability strictly between 0 and 1");
  return static_cast<std::int64_t>(std::ceil(std::log1p(-confidence_level) / std::log1p(-epsilon)));
}

double bound_after(std::int64_t clean_runs, double confidence_level) {
  require_level(confidence_level);
  if (clean_runs <= 0) return 1.0;
  return -std::expm1(std::log1p(-confidence_level) / static_cast<double>(clean_runs));
}

double log_mixture_wealth(std::int64_t failures, std::int64_t runs, double epsilon) {
  require_counts(failures, runs);
  PARALLAX_REQUIRE(epsilon > 0.0 && epsilon < 1.0, "a probability strictly between 0 and 1");
  // The integral of q^k (1-q)^(n-k) over (0, eps) is B(a, b) I_eps(a, b) with
  const double a = static_cast<double>(failures) + 1.0;
  const double b = static_cast<double>(runs - failures) + 1.0;
  if (epsilon < (a + 1.0) / (a + b + 2.0)) {
    // and the powers in front of the continued fraction cancel against the hypothesis' likelihood.
    return std::log1p(-epsilon) + std::log(incomplete_beta_fraction(a, b, epsilon) / a);
  }
  return std::log(incomplete_beta(a, b, epsilon)) + log_beta(a, b) - a * std::log(epsilon) -
         (b - 1.0) * std::log1p(-epsilon);
}

double mixture_upper(std::int64_t failures, std::int64_t runs, double confidence_level) {
  require_level(confidence_level);
  require_counts(failures, runs);
  if (failures == runs) return 1.0;  // the wealth is 1 / (k + 1) for every epsilon
  const double threshold = -std::log1p(-confidence_level);
  // The wealth grows with epsilon from 1 / (k + 1) without bound.
  double low = 0.0, high = 1.0;
  for (double middle = 0.5; middle > low && middle < high; middle = 0.5 * (low + high)) {
    (log_mixture_wealth(failures, runs, middle) < threshold ? low : high) = middle;
  }
  return high;
}

std::int64_t mixture_runs_needed(std::int64_t failures, double confidence_level, double epsilon) {
  require_level(confidence_level);
  require_counts(failures, failures);
  const double threshold = -std::log1p(-confidence_level);
  const auto enough = [&](std::int64_t runs) {
    return log_mixture_wealth(failures, runs, epsilon) >= threshold;
  };
  std::int64_t high = failures + 1;
  while (!enough(high)) high *= 2;
  std::int64_t low = failures;  // never enough: the wealth is 1 / (k + 1)
  while (high - low > 1) {
    const std::int64_t middle = low + (high - low) / 2;
    (enough(middle) ? high : low) = middle;
  }
  return high;
}

double clopper_pearson_upper(std::int64_t failures, std::int64_t runs, double confidence_level) {
  require_level(confidence_level);
  require_counts(failures, runs);
  if (failures == runs) return 1.0;
  if (failures == 0) return bound_after(runs, confidence_level);
  return beta_quantile(confidence_level, static_cast<double>(failures) + 1.0,
                       static_cast<double>(runs - failures));
}

}  // namespace parallax::harness
