#include "harness/confidence/clean_runs.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "compiler/base/contract.h"
#include "harness/sampling/sampler.h"

namespace parallax::harness {
namespace {

/// The mixture's wealth from its definition, by Simpson's rule: shares no code with the
/// continued fraction.
double wealth_by_integration(std::int64_t k, std::int64_t n, double eps) {
  constexpr int kIntervals = 2000;
  const auto ratio = [&](double u) {
    return std::pow(u, static_cast<double>(k)) *
           std::pow((1 - eps * u) / (1 - eps), static_cast<double>(n - k));
  };
  double sum = ratio(0.0) + ratio(1.0);
  for (int i = 1; i < kIntervals; ++i) {
    sum += (i % 2 == 1 ? 4.0 : 2.0) * ratio(static_cast<double>(i) / kIntervals);
  }
  return sum / (3.0 * kIntervals);
}

std::int64_t clopper_pearson_runs(std::int64_t failures, double level, double epsilon) {
  std::int64_t runs = failures + 1;
  while (clopper_pearson_upper(failures, runs, level) > epsilon) ++runs;
  return runs;
}

TEST_CASE("clean runs: the number that excludes epsilon, table for 95 and 99 %") {
  const std::array<double, 5> epsilons = {0.10, 0.05, 0.02, 0.01, 0.001};
  const std::array<std::int64_t, 5> at_95 = {29, 59, 149, 299, 2995};
  const std::array<std::int64_t, 5> at_99 = {44, 90, 228, 459, 4603};
  for (std::size_t i = 0; i < epsilons.size(); ++i) {
    CHECK(runs_needed(0.95, epsilons[i]) == at_95[i]);
    CHECK(runs_needed(0.99, epsilons[i]) == at_99[i]);
  }
  CHECK(runs_needed(0.999, 0.001) == 6905);
}

TEST_CASE("clean runs: all-traces levels of 3, 20 and 100 traces") {
  CHECK(runs_needed(1 - 0.01 / 3, 0.05) == 112);
  CHECK(runs_needed(1 - 0.01 / 20, 0.05) == 149);
  CHECK(runs_needed(1 - 0.01 / 100, 0.05) == 180);
}

TEST_CASE("clean runs: the bound after 7, 20 and 90 clean runs") {
  CHECK(bound_after(7, 0.99) == doctest::Approx(0.482053).epsilon(1e-6));
  CHECK(bound_after(20, 0.99) == doctest::Approx(0.205672).epsilon(1e-5));
  CHECK(std::abs(bound_after(20, 0.99) - 0.205672) < 1e-6);
  CHECK(std::abs(bound_after(90, 0.99) - 0.049881) < 1e-6);
  CHECK(bound_after(0, 0.99) == 1.0);
}

TEST_CASE("clean runs: needed runs are the first whose bound is at most epsilon") {
  for (const double level : {0.5, 0.9, 0.95, 0.99, 0.9999}) {
    for (const double epsilon : {0.5, 0.2, 0.07, 0.003}) {
      const auto n = runs_needed(level, epsilon);
      CHECK(bound_after(n, level) <= epsilon * (1 + 1e-12));
      if (n > 1) CHECK(bound_after(n - 1, level) > epsilon);
    }
  }
}

TEST_CASE("clean runs: the bound is the one of Clopper and Pearson without failures") {
  for (const std::int64_t n : {1, 7, 90, 1000}) {
    CHECK(clopper_pearson_upper(0, n, 0.99) ==
          doctest::Approx(bound_after(n, 0.99)).epsilon(1e-12));
  }
  CHECK(clopper_pearson_upper(3, 3, 0.99) == 1.0);
}

TEST_CASE("Clopper and Pearson: runs that allow 0, 1, 2 and 5 failures") {
  const std::array<std::int64_t, 4> failures = {0, 1, 2, 5};
  const std::array<std::int64_t, 4> at_5 = {90, 130, 165, 259};
  const std::array<std::int64_t, 4> at_1 = {459, 662, 838, 1307};
  for (std::size_t i = 0; i < failures.size(); ++i) {
    CHECK(clopper_pearson_runs(failures[i], 0.99, 0.05) == at_5[i]);
    CHECK(clopper_pearson_runs(failures[i], 0.99, 0.01) == at_1[i]);
  }
}

TEST_CASE("mixture: runs needed with 0 to 3 failures") {
  const std::array<std::int64_t, 4> at_5 = {126, 176, 218, 257};
  const std::array<std::int64_t, 4> at_1 = {644, 896, 1110, 1306};
  for (std::int64_t k = 0; k < 4; ++k) {
    const auto i = static_cast<std::size_t>(k);
    CHECK(mixture_runs_needed(k, 0.99, 0.05) == at_5[i]);
    CHECK(mixture_runs_needed(k, 0.99, 0.01) == at_1[i]);
    // The bound and the number of runs are two sides of one rule.
    CHECK(mixture_upper(k, at_5[i], 0.99) <= 0.05);
    CHECK(mixture_upper(k, at_5[i] - 1, 0.99) > 0.05);
  }
}

TEST_CASE("mixture: the wealth is the integral of its definition") {
  for (const std::int64_t k : {0, 1, 4, 20}) {
    for (const std::int64_t n : {20, 60, 300}) {
      for (const double epsilon : {0.01, 0.05, 0.3, 0.8}) {
        CHECK(log_mixture_wealth(k, n, epsilon) ==
              doctest::Approx(std::log(wealth_by_integration(k, n, epsilon))).epsilon(1e-8));
      }
    }
  }
}

TEST_CASE("mixture: the bound is wider than the one without failures, and 1 without evidence") {
  CHECK(mixture_upper(0, 0, 0.99) == 1.0);
  CHECK(mixture_upper(5, 5, 0.99) == 1.0);
  for (const std::int64_t n : {10, 90, 400}) {
    CHECK(mixture_upper(0, n, 0.99) > bound_after(n, 0.99));
    for (std::int64_t k = 1; k < 5; ++k) {
      CHECK(mixture_upper(k, n, 0.99) > mixture_upper(k - 1, n, 0.99));
      CHECK(mixture_upper(k, n, 0.99) > clopper_pearson_upper(k, n, 0.99));
    }
  }
}

TEST_CASE("mixture: whoever looks after every run is wrong at most as often as stated") {
  // 3000 loops of 600 runs at p = epsilon = 5 %. The true chance of ever being wrong is below 1 %;
  // more than 60 of 3000 has a chance below 1e-6 even at 1 %.
  const double epsilon = 0.05, threshold = std::log(100.0);
  int wrong = 0;
  for (std::uint64_t loop = 0; loop < 3000; ++loop) {
    const CounterRng rng({.campaign_seed = 21, .sample = loop});
    std::int64_t failures = 0;
    for (std::int64_t run = 1; run <= 600; ++run) {
      failures += rng.uniform(static_cast<std::uint64_t>(run)) < epsilon ? 1 : 0;
      if (log_mixture_wealth(failures, run, epsilon) < threshold) continue;
      ++wrong;
      break;
    }
  }
  CHECK(wrong <= 60);
  CHECK(wrong > 0);
}

TEST_CASE("clean runs: figures outside their range are the caller's fault") {
  CHECK_THROWS_AS(runs_needed(1.0, 0.05), base::ContractViolation);
  CHECK_THROWS_AS(runs_needed(0.99, 0.0), base::ContractViolation);
  CHECK_THROWS_AS(mixture_upper(2, 1, 0.99), base::ContractViolation);
}

}  // namespace
}  // namespace parallax::harness
