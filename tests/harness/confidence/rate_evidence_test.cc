// Evidence of a fixed number of runs about one rate or two, compared with sums over all outcomes.

#include "harness/confidence/rate_evidence.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "harness/confidence/clean_runs.h"

namespace parallax::harness {
namespace {

/// P(X = k) of n draws, by Pascal's triangle in long double: no function of the library.
std::vector<double> outcomes(std::int64_t n, double p) {
  std::vector<long double> row = {1.0L};
  for (std::int64_t i = 0; i < n; ++i) {
    row.push_back(0.0L);
    for (std::size_t k = row.size() - 1; k > 0; --k) {
      row[k] = row[k] * (1.0L - p) + row[k - 1] * p;
    }
    row[0] *= 1.0L - p;
  }
  return {row.begin(), row.end()};
}

/// The probability that the counts of n runs are taken for `answer` if the rate is p.
double chance(const RateClaim& claim, std::int64_t n, double p, RateVerdict answer) {
  const auto distribution = outcomes(n, p);
  double sum = 0.0;
  for (std::int64_t k = 0; k <= n; ++k) {
    if (weigh(claim, {n, k, 0}) == answer) sum += distribution[static_cast<std::size_t>(k)];
  }
  return sum;
}

TEST_CASE("a false claim is supported, and a true one refuted, no more often than is said") {
  for (const double confidence : {0.9, 0.99}) {
    const double error = 1.0 - confidence + 1e-12;
    for (const auto& [lower, upper] : {std::pair{0.0, 0.05}, {0.2, 1.0}, {0.1, 0.3}, {0.4, 0.9}}) {
      const RateClaim claim{lower, upper, confidence};
      for (const std::int64_t n : {5, 37, 90, 200}) {
        CAPTURE(n);
        CAPTURE(lower);
        CAPTURE(upper);
        for (int i = 0; i <= 100; ++i) {
          const double p = 0.01 * i;
          const bool is_true = (lower <= 0.0 || lower < p) && (upper >= 1.0 || p < upper);
          if (!is_true) CHECK(chance(claim, n, p, RateVerdict::kSupports) <= error);
          if (is_true) CHECK(chance(claim, n, p, RateVerdict::kRefutes) <= error);
        }
      }
    }
  }
}

TEST_CASE("enough runs do tell") {
  CHECK(chance({0.0, 0.05, 0.99}, 400, 0.01, RateVerdict::kSupports) > 0.95);
  CHECK(chance({0.0, 0.05, 0.99}, 400, 0.15, RateVerdict::kRefutes) > 0.99);
  CHECK(chance({0.1, 0.3, 0.95}, 400, 0.2, RateVerdict::kSupports) > 0.99);
  CHECK(chance({0.1, 0.3, 0.95}, 400, 0.45, RateVerdict::kRefutes) > 0.99);
}

TEST_CASE("lost runs count as what is worse for either answer") {
  const RateClaim rare{0.0, 0.05, 0.99}, often{0.5, 1.0, 0.99};
  CHECK(weigh(rare, {90, 0, 0}) == RateVerdict::kSupports);
  CHECK(weigh(rare, {90, 0, 1}) == RateVerdict::kTooLittle);
  CHECK(weigh(rare, {90, 15, 0}) == RateVerdict::kRefutes);
  CHECK(weigh(rare, {90, 0, 15}) == RateVerdict::kTooLittle);
  CHECK(weigh(often, {20, 20, 0}) == RateVerdict::kSupports);
  CHECK(weigh(often, {20, 15, 5}) == RateVerdict::kTooLittle);
  CHECK(weigh(often, {20, 0, 20}) == RateVerdict::kTooLittle);
  CHECK(weigh(often, {0, 0, 0}) == RateVerdict::kTooLittle);
}

TEST_CASE("the number of runs that can support a claim can, and one less cannot") {
  CHECK(runs_to_support({0.0, 0.05, 0.99}, 1000) == runs_needed(0.99, 0.05));
  CHECK(runs_to_support({0.5, 1.0, 0.99}, 1000) == 7);  // 0.5^7 < 0.01
  CHECK(!runs_to_support({0.5, 0.5001, 0.99}, 10000));
  for (const auto& [lower, upper] : {std::pair{0.1, 0.3}, {0.45, 0.55}, {0.9, 0.95}}) {
    const RateClaim claim{lower, upper, 0.95};
    const auto supports = [&](std::int64_t n) {
      for (std::int64_t k = 0; k <= n; ++k) {
        if (weigh(claim, {n, k, 0}) == RateVerdict::kSupports) return true;
      }
      return false;
    };
    const auto enough = runs_to_support(claim, 100000);
    REQUIRE(enough);
    CHECK(supports(*enough));
    CHECK_FALSE(supports(*enough - 1));
  }
}

TEST_CASE("how many runs would tell is told, if any would") {
  const RateClaim claim{0.0, 0.05, 0.99};
  const RateCounts few{100, 2, 0};
  REQUIRE(weigh(claim, few) == RateVerdict::kTooLittle);
  const auto enough = runs_to_tell(claim, few, 100000);
  REQUIRE(enough);
  CHECK(*enough > 100);
  CHECK(weigh(claim, {*enough, std::llround(0.02 * static_cast<double>(*enough)), 0}) ==
        RateVerdict::kSupports);
  CHECK(!runs_to_tell(claim, {100, 5, 0}, 100000));   // the border itself
  CHECK(!runs_to_tell(claim, {100, 0, 50}, 100000));  // the lost ones hide it
}

/// C(n, k), exact up to n of about 60.
long double choose(std::int64_t n, std::int64_t k) {
  if (k < 0 || k > n) return 0.0L;
  long double out = 1.0L;
  for (std::int64_t i = 1; i <= k; ++i) out = out * (n - k + i) / i;
  return out;
}

TEST_CASE("Fisher's exact test is the tail of the hypergeometric distribution") {
  for (const auto& [n, m] : {std::pair{20, 20}, {30, 12}, {7, 25}}) {
    for (std::int64_t before = 0; before <= n; before += 3) {
      for (std::int64_t after = 0; after <= m; after += 2) {
        long double tail = 0.0L;
        for (std::int64_t k = after; k <= m; ++k)
          tail += choose(m, k) * choose(n, before + after - k);
        const double expected = static_cast<double>(tail / choose(n + m, before + after));
        CHECK(fisher_worse({n, before, 0}, {m, after, 0}) ==
              doctest::Approx(expected).epsilon(1e-9));
      }
    }
  }
  // The lady tasting tea: all four of four, none of four.
  CHECK(fisher_worse({4, 0, 0}, {4, 4, 0}) == doctest::Approx(1.0 / 70.0));
  CHECK(fisher_worse({4, 0, 1}, {4, 3, 1}) == doctest::Approx(fisher_worse({4, 1, 0}, {4, 3, 0})));
}

TEST_CASE("both statements about two rates are false no more often than is said") {
  constexpr std::int64_t kRuns = 25;
  for (int i = 0; i <= 10; ++i) {
    for (int j = 0; j <= 10; ++j) {
      const double p = 0.1 * i, q = 0.1 * j;
      const auto before = outcomes(kRuns, p), after = outcomes(kRuns, q);
      double worse = 0.0, exceeded = 0.0;
      for (std::int64_t k = 0; k <= kRuns; ++k) {
        for (std::int64_t l = 0; l <= kRuns; ++l) {
          const double weight =
              before[static_cast<std::size_t>(k)] * after[static_cast<std::size_t>(l)];
          if (fisher_worse({kRuns, k, 0}, {kRuns, l, 0}) <= 0.05) worse += weight;
          if (excess_bound({kRuns, k, 0}, {kRuns, l, 0}, 0.95) < q - p - 1e-12) exceeded += weight;
        }
      }
      CAPTURE(p);
      CAPTURE(q);
      if (q <= p) CHECK(worse <= 0.05);
      CHECK(exceeded <= 0.05);
    }
  }
  CHECK(excess_bound({25, 5, 3}, {25, 5, 3}, 0.95) == excess_bound({25, 5, 0}, {25, 8, 0}, 0.95));
}

TEST_CASE("runs that end as soon as they tell are taken for a false answer as seldom as is said") {
  // All ways through 150 runs at once: the probability of each count that has not decided yet.
  constexpr std::int64_t kRuns = 150;
  for (const auto& [lower, upper] : {std::pair{0.0, 0.1}, {0.2, 1.0}, {0.3, 0.7}}) {
    const RateClaim claim{lower, upper, 0.9};
    std::vector<std::vector<RateVerdict>> told(kRuns + 1);
    for (std::int64_t n = 1; n <= kRuns; ++n) {
      for (std::int64_t k = 0; k <= n; ++k) {
        told[static_cast<std::size_t>(n)].push_back(weigh(claim, {n, k, 0, false}));
      }
    }
    for (int i = 0; i <= 20; ++i) {
      const double p = 0.05 * i;
      double supported = 0.0, refuted = 0.0;
      std::vector<double> open = {1.0};
      for (std::size_t n = 1; n <= kRuns; ++n) {
        std::vector<double> next(n + 1, 0.0);
        for (std::size_t k = 0; k < open.size(); ++k) {
          next[k] += open[k] * (1.0 - p);
          next[k + 1] += open[k] * p;
        }
        for (std::size_t k = 0; k < next.size(); ++k) {
          if (told[n][k] == RateVerdict::kTooLittle) continue;
          (told[n][k] == RateVerdict::kSupports ? supported : refuted) += next[k];
          next[k] = 0.0;
        }
        open = std::move(next);
      }
      CAPTURE(p);
      CAPTURE(upper);
      const bool is_true = (lower <= 0.0 || lower < p) && (upper >= 1.0 || p < upper);
      CHECK((is_true ? refuted : supported) <= 0.1 + 1e-12);
      if (std::abs(p - 0.5) < 0.01) CHECK((is_true ? supported : refuted) > 0.4);
    }
  }
  CHECK(can_support({0.0, 0.05, 0.99}, 126, false));
  CHECK_FALSE(can_support({0.0, 0.05, 0.99}, 125, false));
}

TEST_CASE("statements about two rates hold for whoever ends both when it suits him") {
  // Looks at each rate after every run and takes the number that is worst for the statement. Equal
  // rates: 4,000 times with an error of at most 10 % exceed 12 % with a probability below 1e-4.
  constexpr std::int64_t kRuns = 80;
  constexpr std::uint64_t kLoops = 4000;
  constexpr double kLevel = 0.9, kSide = 0.95;
  std::vector<std::vector<double>> upper(kRuns + 1);
  for (std::int64_t n = 1; n <= kRuns; ++n) {
    for (std::int64_t k = 0; k <= n; ++k) {
      upper[static_cast<std::size_t>(n)].push_back(mixture_upper(k, n, kSide));
    }
  }
  std::uint64_t seed = 1;
  const auto uniform = [&seed] {  // SplitMix64
    std::uint64_t z = (seed += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
    return static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1p-53;
  };
  struct Ends {
    RateCounts lowest, highest;  // where the upper bound is least, the lower bound greatest
  };
  const auto play = [&](double p) {
    Ends out;
    double least = 2.0, least_of_clean = 2.0;
    std::int64_t k = 0;
    for (std::int64_t n = 1; n <= kRuns; ++n) {
      k += uniform() < p ? 1 : 0;
      const auto& row = upper[static_cast<std::size_t>(n)];
      if (row[static_cast<std::size_t>(k)] < least) {
        least = row[static_cast<std::size_t>(k)];
        out.lowest = {n, k, 0, false};
      }
      if (row[static_cast<std::size_t>(n - k)] < least_of_clean) {
        least_of_clean = row[static_cast<std::size_t>(n - k)];
        out.highest = {n, k, 0, false};
      }
    }
    return out;
  };
  for (const double p : {0.05, 0.5}) {
    std::uint64_t worse = 0, exceeded = 0;
    for (std::uint64_t loop = 0; loop < kLoops; ++loop) {
      const auto before = play(p), after = play(p);
      worse += is_surely_worse(before.lowest, after.highest, kLevel) ? 1 : 0;
      exceeded += excess_bound(before.highest, after.lowest, kLevel) < 0.0 ? 1 : 0;
    }
    CAPTURE(p);
    CHECK(worse <= kLoops * 12 / 100);
    CHECK(exceeded <= kLoops * 12 / 100);
  }
  CHECK(is_surely_worse({100, 2, 0, false}, {100, 40, 0, false}, 0.99));
  CHECK(is_surely_worse({100, 2, 0}, {100, 40, 0, false}, 0.99));
  CHECK_FALSE(is_surely_worse({100, 2, 30, false}, {100, 40, 0, false}, 0.95));
}

TEST_CASE(
    "Fisher's test of a thousand million runs takes no longer than its distribution is wide") {
  constexpr std::int64_t kRuns = 1'000'000'000;
  CHECK(fisher_worse({kRuns, kRuns / 2, 0}, {kRuns, kRuns / 2, 0}) ==
        doctest::Approx(0.5).epsilon(0.01));
  CHECK(fisher_worse({kRuns, 10, 0}, {kRuns, 900'000'000, 0}) < 1e-9);
  CHECK(fisher_worse({kRuns, 900'000'000, 0}, {kRuns, 10, 0}) == 1.0);
}

}  // namespace
}  // namespace parallax::harness
