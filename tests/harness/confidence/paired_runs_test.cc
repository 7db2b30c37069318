// Paired runs: errors by exact sums over all outcomes, lost runs by trying every result.

#include "harness/confidence/paired_runs.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace parallax::harness {
namespace {

PairedRuns pairs(int clean, int gained, int mended, int failed) {
  PairedRuns out;
  const auto add = [&](int count, RunResult before, RunResult after) {
    for (int i = 0; i < count; ++i) out.add(before, after);
  };
  add(clean, RunResult::kClean, RunResult::kClean);
  add(gained, RunResult::kClean, RunResult::kFailure);
  add(mended, RunResult::kFailure, RunResult::kClean);
  add(failed, RunResult::kFailure, RunResult::kFailure);
  return out;
}

/// The probability that `holds` of n pairs, with these probabilities of discordant ones.
double probability(int n, double gain, double mend, const std::function<bool(int, int)>& holds) {
  const auto power = [](double p, int k) { return k == 0 ? 0.0 : k * std::log(p); };
  double sum = 0.0;
  for (int gained = 0; gained <= n; ++gained) {
    for (int mended = 0; gained + mended <= n; ++mended) {
      if (!holds(gained, mended)) continue;
      const int rest = n - gained - mended;
      sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(gained + 1.0) - std::lgamma(mended + 1.0) -
                      std::lgamma(rest + 1.0) + power(gain, gained) + power(mend, mended) +
                      power(1.0 - gain - mend, rest));
    }
  }
  return sum;
}

TEST_CASE("a rate that has not grown looks worse no more often than is said") {
  for (const double error : {0.05, 0.01}) {
    for (const int n : {6, 25, 60}) {
      for (const double mend : {0.01, 0.1, 0.3, 0.5}) {
        for (const double part : {0.3, 1.0}) {
          const auto broken = [&](int gained, int mended) {
            return mcnemar_worse(pairs(n - gained - mended, gained, mended, 0)) <= error;
          };
          CHECK(probability(n, part * mend, mend, broken) <= error + 1e-12);
        }
      }
    }
  }
}

TEST_CASE("the bound of the excess holds as often as it says") {
  for (const double confidence : {0.9, 0.99}) {
    for (const int n : {10, 40}) {
      for (const double gain : {0.02, 0.2, 0.45}) {
        for (const double mend : {0.02, 0.2, 0.45}) {
          const auto wrong = [&](int gained, int mended) {
            const auto runs = pairs(n - gained - mended, gained, mended, 0);
            return paired_excess_bound(runs, confidence) <= gain - mend;
          };
          CHECK(probability(n, gain, mend, wrong) <= 1.0 - confidence + 1e-12);
        }
      }
    }
  }
}

TEST_CASE("pairs that agree say nothing, and equal starts make few runs enough") {
  CHECK(mcnemar_worse(pairs(50, 6, 0, 30)) == doctest::Approx(std::pow(0.5, 6)));
  CHECK(mcnemar_worse(pairs(0, 6, 0, 0)) == doctest::Approx(std::pow(0.5, 6)));
  CHECK(mcnemar_worse(pairs(5, 0, 0, 5)) == 1.0);
  CHECK(mcnemar_worse(pairs(5, 2, 1, 5)) == doctest::Approx(0.5));  // (3 + 1) / 8
  // As for no failure on either side, however many pairs fail on both.
  CHECK(paired_excess_bound(pairs(70, 0, 0, 30), 0.95) ==
        doctest::Approx(1.0 - std::pow(0.025, 0.01)));
  CHECK(paired_excess_bound(PairedRuns{}, 0.95) == 1.0);
}

TEST_CASE("lost runs are the worst for either answer") {
  constexpr int kPairs = 3;
  int patterns = 1;
  for (int i = 0; i < 2 * kPairs; ++i) patterns *= 3;
  for (int code = 0; code < patterns; ++code) {
    std::vector<RunResult> results;
    int lost = 0;
    for (int i = 0, rest = code; i < 2 * kPairs; ++i, rest /= 3) {
      results.push_back(static_cast<RunResult>(rest % 3));
      lost += results.back() == RunResult::kLost ? 1 : 0;
    }
    const auto made = [&](int choice) {
      PairedRuns out;
      auto seen = results;
      for (auto& one : seen) {
        if (one != RunResult::kLost || choice < 0) continue;
        one = (choice & 1) != 0 ? RunResult::kFailure : RunResult::kClean;
        choice >>= 1;
      }
      for (std::size_t i = 0; i < seen.size(); i += 2) out.add(seen[i], seen[i + 1]);
      return out;
    };
    double p = 0.0, bound = -1.0;
    for (int choice = 0; choice < 1 << lost; ++choice) {
      p = std::max(p, mcnemar_worse(made(choice)));
      bound = std::max(bound, paired_excess_bound(made(choice), 0.9));
    }
    const auto cautious = made(-1);
    if (std::abs(mcnemar_worse(cautious) - p) > 1e-12) FAIL_CHECK("p of pattern " << code);
    if (std::abs(paired_excess_bound(cautious, 0.9) - bound) > 1e-9) {
      FAIL_CHECK("bound of pattern " << code);
    }
  }
}

}  // namespace
}  // namespace parallax::harness
