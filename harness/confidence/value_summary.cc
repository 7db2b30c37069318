// Mean and quantiles of independent values, without a supposition about their distribution where
// that is possible.
//
// At least a share q of the distribution lies at or below its q-quantile Q, so fewer than l values
// are <= Q with a probability of at most P(Bin(n, q) < l); at most a share q lies below Q, so u
// values or more are < Q with at most P(Bin(n, q) >= u). The l-th and u-th least values bound Q
// with the error that the two tails leave (Thompson 1936; David and Nagaraja, Order Statistics).
//
// Unknown values are placed below all others for the lower end and above them for the upper one.
// The ranks of n + 1 values exceed those of n by 0 or 1, so the interval also contains the one for
// unknown runs that had no value at all.
//
// Cost: one sort, and some incomplete beta functions for each quantile.

#include "harness/confidence/value_summary.h"

#include <algorithm>
#include <cmath>

#include "compiler/base/contract.h"
#include "harness/confidence/quantiles.h"

namespace parallax::harness {
namespace {

/// The value of a rank among `sorted` values with `below` unknown ones before them.
std::optional<double> ranked_value(const std::vector<double>& sorted, std::int64_t rank,
                                   std::int64_t below) {
  const std::int64_t at = rank - 1 - below;
  if (at < 0 || at >= std::ssize(sorted)) return std::nullopt;
  return sorted[static_cast<std::size_t>(at)];
}

void add_moments(ValueSummary& out, const std::vector<double>& values,
                 std::optional<double> confidence_level) {
  const auto count = static_cast<double>(out.count);
  for (const double value : values) out.mean += value / count;
  if (out.count < 2) return;
  double squares = 0.0;
  for (const double value : values) squares += (value - out.mean) * (value - out.mean);
  out.sd = std::sqrt(squares / (count - 1.0));
  // Equal values show nothing about how far others may lie from them.
  if (!confidence_level || out.least == out.most) return;
  const double half =
      student_t_quantile(0.5 * (1.0 + *confidence_level), count - 1.0) * out.sd / std::sqrt(count);
  out.mean_lower = out.mean - half;
  out.mean_upper = out.mean + half;
}

}  // namespace

QuantileRanks quantile_ranks(std::int64_t n, double probability, double confidence_level) {
  PARALLAX_REQUIRE(n >= 0, "a number of values");
  PARALLAX_REQUIRE(probability > 0.0 && probability < 1.0, "a probability in (0, 1)");
  PARALLAX_REQUIRE(confidence_level > 0.0 && confidence_level < 1.0, "a confidence in (0, 1)");
  const double tail = 0.5 * (1.0 - confidence_level);
  QuantileRanks out{0, n + 1};
  std::int64_t high = n + 1;  // P(Bin < lower) <= tail, and it is exceeded at `high`
  while (high - out.lower > 1) {
    const std::int64_t middle = out.lower + (high - out.lower) / 2;
    (binomial_at_most(middle - 1, n, probability) <= tail ? out.lower : high) = middle;
  }
  std::int64_t low = 0;  // P(Bin >= upper) <= tail, and it is exceeded at `low`
  while (out.upper - low > 1) {
    const std::int64_t middle = low + (out.upper - low) / 2;
    (binomial_at_least(middle, n, probability) <= tail ? out.upper : low) = middle;
  }
  return out;
}

ValueSummary summarize_values(std::vector<double> values, std::int64_t unknown,
                              const std::vector<double>& probabilities,
                              std::optional<double> confidence_level) {
  PARALLAX_REQUIRE(!values.empty() && unknown >= 0, "at least one value");
  std::sort(values.begin(), values.end());
  ValueSummary out;
  out.count = std::ssize(values);
  out.least = values.front();
  out.most = values.back();
  add_moments(out, values, confidence_level);
  for (const double probability : probabilities) {
    QuantileEstimate one{probability, 0.0, {}, {}};
    // 0.95 * 20 is 19, whatever its last bit says.
    const double share = probability * static_cast<double>(out.count) - 1e-9;
    const auto rank = static_cast<std::int64_t>(std::ceil(share));
    one.value = *ranked_value(values, std::clamp<std::int64_t>(rank, 1, out.count), 0);
    if (confidence_level) {
      const auto ranks = quantile_ranks(out.count + unknown, probability, *confidence_level);
      one.lower = ranked_value(values, ranks.lower, unknown);
      one.upper = ranked_value(values, ranks.upper, 0);
    }
    out.quantiles.push_back(one);
  }
  return out;
}

}  // namespace parallax::harness
