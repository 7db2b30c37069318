// Means and quantiles: exact coverage over all outcomes of small random worlds.

#include "harness/confidence/value_summary.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "harness/confidence/quantiles.h"
#include "harness/sampling/sampler.h"

namespace parallax::harness {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// P(X = k) of n draws, by Pascal's triangle.
std::vector<double> binomial(std::int64_t n, double p) {
  std::vector<long double> row = {1.0L};
  for (std::int64_t i = 0; i < n; ++i) {
    row.push_back(0.0L);
    for (std::size_t k = row.size() - 1; k > 0; --k) row[k] = row[k] * (1.0L - p) + row[k - 1] * p;
    row[0] *= 1.0L - p;
  }
  return {row.begin(), row.end()};
}

TEST_CASE("ranks are the tightest whose tails are within the error") {
  for (const double confidence : {0.8, 0.95, 0.999}) {
    const double tail = 0.5 * (1.0 - confidence);
    for (const double q : {0.05, 0.3, 0.5, 0.95}) {
      for (const std::int64_t n : {1, 7, 40, 133}) {
        const auto row = binomial(n, q);
        std::int64_t lower = 0, upper = n + 1;
        double sum = 0.0;
        for (std::int64_t k = 0; k < n; ++k) {
          sum += row[static_cast<std::size_t>(k)];
          if (sum <= tail) lower = k + 1;  // P(X < k + 1)
        }
        sum = 0.0;
        for (std::int64_t k = n; k > 0; --k) {
          sum += row[static_cast<std::size_t>(k)];
          if (sum <= tail) upper = k;
        }
        const auto ranks = quantile_ranks(n, q, confidence);
        CHECK(ranks.lower == lower);
        CHECK(ranks.upper == upper);
      }
    }
  }
}

TEST_CASE("intervals of quantiles cover them in every world with a few values") {
  const CounterRng rng({.campaign_seed = 4, .sample = 1});
  std::uint64_t draw = 0;
  double least = 1.0;
  for (int world = 0; world < 60; ++world) {
    const double a = rng.uniform(draw++), b = rng.uniform(draw++), c = rng.uniform(draw++);
    const std::vector<double> law = {a / (a + b + c), b / (a + b + c), c / (a + b + c)};
    const double q = 0.1 + 0.8 * rng.uniform(draw++);
    const double confidence = 0.5 + 0.45 * rng.uniform(draw++);
    const double quantile = law[0] >= q ? 1.0 : law[0] + law[1] >= q ? 2.0 : 3.0;
    for (const int n : {4, 9, 14}) {
      double too_high = 0.0, too_low = 0.0;
      for (int ones = 0; ones <= n; ++ones) {
        for (int twos = 0; ones + twos <= n; ++twos) {
          const int threes = n - ones - twos;
          const double chance =
              std::exp(std::lgamma(n + 1.0) - std::lgamma(ones + 1.0) - std::lgamma(twos + 1.0) -
                       std::lgamma(threes + 1.0) + ones * std::log(law[0]) +
                       twos * std::log(law[1]) + threes * std::log(law[2]));
          std::vector<double> values(static_cast<std::size_t>(ones), 1.0);
          values.insert(values.end(), static_cast<std::size_t>(twos), 2.0);
          values.insert(values.end(), static_cast<std::size_t>(threes), 3.0);
          const auto found = summarize_values(values, 0, {q}, confidence).quantiles[0];
          if (found.lower.value_or(-kInfinity) > quantile) too_high += chance;
          if (found.upper.value_or(kInfinity) < quantile) too_low += chance;
        }
      }
      CHECK(too_high <= 0.5 * (1.0 - confidence) + 1e-9);
      CHECK(too_low <= 0.5 * (1.0 - confidence) + 1e-9);
      least = std::min(least, 1.0 - too_high - too_low - confidence);
    }
  }
  CHECK(least < 0.1);  // nor are they needlessly wide everywhere
}

TEST_CASE("an interval with unknown runs contains that of whatever they may have reported") {
  const CounterRng rng({.campaign_seed = 5, .sample = 1});
  std::uint64_t draw = 0;
  for (int world = 0; world < 2000; ++world) {
    std::vector<double> known;
    const int count = 1 + static_cast<int>(30 * rng.uniform(draw++));
    for (int i = 0; i < count; ++i) known.push_back(std::floor(10 * rng.uniform(draw++)));
    const int unknown = static_cast<int>(5 * rng.uniform(draw++));
    const double q = 0.05 + 0.9 * rng.uniform(draw++);
    const auto cautious = summarize_values(known, unknown, {q}, 0.8).quantiles[0];
    auto all = known;
    for (int i = 0; i < unknown; ++i) {  // a third of them had no value
      const double kind = rng.uniform(draw++);
      if (kind < 0.67) all.push_back(std::floor(30 * rng.uniform(draw++)) - 10);
    }
    const auto whole = summarize_values(all, 0, {q}, 0.8).quantiles[0];
    CHECK(cautious.lower.value_or(-kInfinity) <= whole.lower.value_or(-kInfinity));
    CHECK(cautious.upper.value_or(kInfinity) >= whole.upper.value_or(kInfinity));
  }
}

TEST_CASE("mean, spread and quantiles of numbers that are known by heart") {
  const auto found = summarize_values({4.0, 1.0, 3.0, 2.0}, 0, {0.25, 0.5, 0.95}, 0.95);
  CHECK(found.count == 4);
  CHECK(found.mean == doctest::Approx(2.5));
  CHECK(found.sd == doctest::Approx(1.2909944487));
  CHECK(found.least == 1.0);
  CHECK(found.most == 4.0);
  // t(0.975, 3) = 3.1824463053
  CHECK(*found.mean_lower == doctest::Approx(2.5 - 3.1824463053 * 1.2909944487 / 2));
  CHECK(*found.mean_upper == doctest::Approx(2.5 + 3.1824463053 * 1.2909944487 / 2));
  CHECK(found.quantiles[0].value == 1.0);
  CHECK(found.quantiles[1].value == 2.0);
  CHECK(found.quantiles[2].value == 4.0);
  CHECK_FALSE(found.quantiles[2].upper.has_value());
  const auto without = summarize_values({4.0, 1.0}, 0, {0.5}, {});
  CHECK_FALSE(without.mean_lower.has_value());
  CHECK_FALSE(without.quantiles[0].lower.has_value());
  const auto equal = summarize_values({2.0, 2.0, 2.0}, 0, {0.5}, 0.95);
  CHECK(equal.sd == 0.0);
  CHECK_FALSE(equal.mean_lower.has_value());
  CHECK_FALSE(summarize_values({2.0}, 0, {0.5}, 0.95).mean_upper.has_value());
}

TEST_CASE("the interval of the mean covers it in most worlds as often as it says, nearly") {
  constexpr int kTrials = 4000;
  constexpr double kError = 4 * 0.0035;  // four standard errors
  const auto coverage = [&](int n, double mean, const auto& value, std::uint64_t seed) {
    int covered = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      const CounterRng rng({.campaign_seed = seed, .sample = static_cast<std::uint64_t>(trial)});
      std::vector<double> values;
      for (int i = 0; i < n; ++i)
        values.push_back(value(rng.uniform(static_cast<std::uint64_t>(i))));
      const auto found = summarize_values(std::move(values), 0, {}, 0.95);
      covered += *found.mean_lower <= mean && mean <= *found.mean_upper ? 1 : 0;
    }
    return static_cast<double>(covered) / kTrials;
  };
  const auto normal = [](double u) { return normal_quantile(std::max(u, 1e-12)); };
  CHECK(coverage(5, 0.0, normal, 1) == doctest::Approx(0.95).epsilon(kError));
  CHECK(coverage(
            100, 0.5, [](double u) { return u; }, 2) == doctest::Approx(0.95).epsilon(kError));
  // Skewed: a little less often than it says, which is why it is called approximate.
  const double skewed = coverage(
      100, 1.0, [](double u) { return -std::log1p(-u); }, 3);
  CHECK(skewed > 0.92);
  CHECK(skewed < 0.955);
}

}  // namespace
}  // namespace parallax::harness
