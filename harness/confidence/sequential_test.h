#pragma once

#include <cstdint>
#include <string_view>

#include "compiler/base/word_table.h"
#include "harness/confidence/run_result.h"

namespace parallax::harness {

/// The two hypotheses of a sequential test about a probability p: p <= lower against p >= upper.
/// In between is the indifference region, where either answer is acceptable.
struct IndifferenceRegion {
  double lower = 0.0, upper = 0.0;  // 0 < lower < upper < 1
  double confidence_level = 0.95;   // of either answer, in (0, 1)
};

enum class SequentialAnswer : std::uint8_t {
  kOpen,       // more runs are needed
  kBelow,      // p < upper
  kAbove,      // p > lower
  kUnsettled,  // the results of the lost runs would decide; further runs do not help
};

inline constexpr auto kSequentialAnswerWords =
    base::word_table<SequentialAnswer>("undecided", "below", "above", "unsettled");
constexpr std::string_view to_string(SequentialAnswer answer) {
  return kSequentialAnswerWords.of(answer);
}

/// Wald's sequential probability ratio test for a Bernoulli probability. It answers kBelow with a
/// probability of at most 1 - C if p >= upper, and kAbove with at most 1 - C if p <= lower,
/// wherever the runs end. It has the answer that all results of the lost runs lead to.
class SequentialTest {
 public:
  explicit SequentialTest(const IndifferenceRegion& region);

  /// Counts one more run, in the order of the sample numbers. Runs after an answer change nothing.
  void add(RunResult result);
  SequentialAnswer answer() const;

 private:
  /// The test of one sequence of results.
  struct Walk {
    std::int64_t failures = 0;
    SequentialAnswer answer = SequentialAnswer::kOpen;
  };
  void count(Walk& walk, bool failed) const;

  double failure_step_, clean_step_, boundary_;  // natural logarithms
  std::int64_t runs_ = 0;
  Walk most_, least_;  // all lost runs taken as failures, or as clean runs
};

}  // namespace parallax::harness
