// The sequential test: its errors by exact sums over the binomial lattice, and lost runs by trying
// every result that they may have had.

#include "harness/confidence/sequential_test.h"

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <vector>

#include "compiler/base/contract.h"

namespace parallax::harness {
namespace {

/// How the test ends within `most` runs.
struct Ends {
  double below = 0.0, above = 0.0, open = 0.0, mean_runs = 0.0;
};

/// By exact sums: where it is still open, the test depends on the number of failures alone.
Ends ends_of(const IndifferenceRegion& region, double p, int most) {
  struct Node {
    double probability = 0.0;
    SequentialTest test;
  };
  std::map<int, Node> open;
  open.emplace(0, Node{1.0, SequentialTest(region)});
  Ends out;
  for (int run = 1; run <= most; ++run) {
    std::map<int, Node> next;
    for (const auto& [failures, node] : open) {
      out.mean_runs += node.probability;
      for (const bool failed : {false, true}) {
        const double chance = node.probability * (failed ? p : 1.0 - p);
        auto test = node.test;
        test.add(failed ? RunResult::kFailure : RunResult::kClean);
        if (test.answer() == SequentialAnswer::kBelow) {
          out.below += chance;
        } else if (test.answer() == SequentialAnswer::kAbove) {
          out.above += chance;
        } else {
          next.emplace(failures + (failed ? 1 : 0), Node{0.0, test}).first->second.probability +=
              chance;
        }
      }
    }
    open = std::move(next);
  }
  for (const auto& [failures, node] : open) out.open += node.probability;
  return out;
}

TEST_CASE("either answer is wrong at most as often as is said") {
  const std::vector<IndifferenceRegion> regions = {{0.03, 0.05, 0.95},
                                                   {0.1, 0.2, 0.99},
                                                   {0.4, 0.6, 0.9},
                                                   {0.005, 0.05, 0.99},
                                                   {0.8, 0.95, 0.95}};
  for (const auto& region : regions) {
    CAPTURE(region.lower);
    CAPTURE(region.upper);
    const double error = 1.0 - region.confidence_level;
    for (const int most : {40, 600}) {
      for (const double beyond : {0.0, 0.01, 0.05}) {
        if (region.upper + beyond < 1.0) {
          CHECK(ends_of(region, region.upper + beyond, most).below <= error + 1e-12);
        }
        if (region.lower > beyond) {
          CHECK(ends_of(region, region.lower - beyond, most).above <= error + 1e-12);
        }
      }
    }
    const auto at_upper = ends_of(region, region.upper, 600);
    CHECK(at_upper.below + at_upper.above + at_upper.open == doctest::Approx(1.0));
  }
}

TEST_CASE("answers come, and soon where the rate is far from the region") {
  const IndifferenceRegion region{0.03, 0.05, 0.95};
  const auto far = ends_of(region, 0.2, 1500);
  CHECK(far.above > 0.9999);
  CHECK(far.mean_runs < 50);
  const auto near = ends_of(region, 0.04, 3000);
  CHECK(near.below + near.above > 0.97);
  CHECK(near.mean_runs > 300);
  // The least number of clean runs: those whose likelihood ratio reaches 20.
  SequentialTest test(region);
  int runs = 0;
  while (test.answer() == SequentialAnswer::kOpen) {
    test.add(RunResult::kClean);
    ++runs;
  }
  CHECK(runs == static_cast<int>(std::ceil(std::log(20.0) / std::log(0.97 / 0.95))));
  CHECK(test.answer() == SequentialAnswer::kBelow);
}

/// The answer to a sequence without losses, from products of probabilities.
SequentialAnswer plain_answer(const IndifferenceRegion& region, const std::vector<bool>& failed) {
  const long double limit = 1.0L / (1.0L - region.confidence_level);
  long double ratio = 1.0L;
  for (const bool one : failed) {
    ratio *= one ? static_cast<long double>(region.upper) / region.lower
                 : (1.0L - region.upper) / (1.0L - region.lower);
    if (ratio >= limit) return SequentialAnswer::kAbove;
    if (ratio * limit <= 1.0L) return SequentialAnswer::kBelow;
  }
  return SequentialAnswer::kOpen;
}

TEST_CASE("the answer is the one that all results of lost runs would lead to") {
  const IndifferenceRegion region{0.21, 0.63, 0.83};
  constexpr int kRuns = 8;
  int sequences = 1, answered = 0, unsettled = 0;
  for (int i = 0; i < kRuns; ++i) sequences *= 3;
  for (int code = 0; code < sequences; ++code) {
    SequentialTest test(region);
    std::vector<RunResult> results;
    for (int i = 0, rest = code; i < kRuns; ++i, rest /= 3) {
      results.push_back(static_cast<RunResult>(rest % 3));
      test.add(results.back());
    }
    bool all_below = true, all_above = true, any_open = false;
    for (int choice = 0; choice < 1 << kRuns; ++choice) {
      std::vector<bool> failed;
      bool is_new = true;
      for (int i = 0; i < kRuns; ++i) {
        const bool bit = (choice >> i & 1) != 0;
        const auto result = results[static_cast<std::size_t>(i)];
        is_new = is_new && (result == RunResult::kLost || !bit);
        failed.push_back(result == RunResult::kLost ? bit : result == RunResult::kFailure);
      }
      if (!is_new) continue;  // the same choice as one without the bit
      const auto answer = plain_answer(region, failed);
      all_below = all_below && answer == SequentialAnswer::kBelow;
      all_above = all_above && answer == SequentialAnswer::kAbove;
      any_open = any_open || answer == SequentialAnswer::kOpen;
    }
    const auto answer = test.answer();
    const bool is_right = (answer == SequentialAnswer::kBelow) == all_below &&
                          (answer == SequentialAnswer::kAbove) == all_above;
    if (!is_right) FAIL_CHECK("sequence " << code);
    answered += all_below || all_above ? 1 : 0;
    unsettled += answer == SequentialAnswer::kUnsettled ? 1 : 0;
  }
  CHECK(answered > 1000);
  CHECK(unsettled > 10);
}

TEST_CASE("once the lost runs decide, further runs do not") {
  SequentialTest test({0.2, 0.6, 0.8});
  for (int i = 0; i < 12; ++i) test.add(RunResult::kLost);
  CHECK(test.answer() == SequentialAnswer::kUnsettled);
  for (int i = 0; i < 1000; ++i) test.add(RunResult::kClean);
  CHECK(test.answer() == SequentialAnswer::kUnsettled);
  CHECK(to_string(test.answer()) == "unsettled");
}

TEST_CASE("regions without room are refused") {
  CHECK_THROWS_AS(SequentialTest({0.0, 0.1, 0.95}), base::ContractViolation);
  CHECK_THROWS_AS(SequentialTest({0.2, 0.2, 0.95}), base::ContractViolation);
  CHECK_THROWS_AS(SequentialTest({0.2, 1.0, 0.95}), base::ContractViolation);
}

}  // namespace
}  // namespace parallax::harness
