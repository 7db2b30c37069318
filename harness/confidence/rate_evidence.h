#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace parallax::harness {

/// The claim that a probability lies from `lower` to `upper`; 0 below and 1 above bound nothing.
struct RateClaim {
  double lower = 0.0, upper = 1.0;
  double confidence_level = 0.95;  // in (0, 1)

  bool bounds_nothing() const { return lower <= 0.0 && upper >= 1.0; }
};

/// "below 5 %", "above 30 %", "from 10 to 30 %"
std::string to_string(const RateClaim& claim);

/// The counts of a number of independent runs.
struct RateCounts {
  std::int64_t runs = 0;      // lost ones as well
  std::int64_t failures = 0;  // that were observed
  std::int64_t lost = 0;      // taken in the worst case, for either answer
  bool fixed = true;          // was `runs` fixed in advance? Else it may depend on the results
};

enum class RateVerdict : std::uint8_t {
  kSupports,   // the claim is true
  kRefutes,    // it is false
  kTooLittle,  // neither can be said with this confidence
};

/// Weighs the counts as evidence for the claim, by exact binomial tests, or by bounds that hold at
/// any time (mixture_upper) if the number of runs was not fixed. The probability of support for a
/// false claim, and of refutation of a true one, is at most 1 - C each. Support takes the bounds of
/// both sides at C, which is enough for both together (an intersection-union test); refutation
/// takes one of them, at 1 - (1-C)/2 where there are two.
RateVerdict weigh(const RateClaim& claim, const RateCounts& counts);

/// Can this number of runs support the claim, whatever their results? With `fixed` false: can it be
/// supported by this number or earlier?
bool can_support(const RateClaim& claim, std::int64_t runs, bool fixed = true);

/// The least number of runs that can support the claim; none up to `most`.
std::optional<std::int64_t> runs_to_support(const RateClaim& claim, std::int64_t most,
                                            bool fixed = true);

/// A number of runs that would tell if failures and losses stay as frequent as they are; none up to
/// `most`, as where the rate is the border itself.
std::optional<std::int64_t> runs_to_tell(const RateClaim& claim, const RateCounts& counts,
                                         std::int64_t most);

/// Clopper and Pearson 1934: bounds of one side, for a number of runs fixed in advance.
double clopper_pearson_lower(std::int64_t failures, std::int64_t runs, double confidence_level);

/// Are failures more probable in `after` than in `before`? Fisher's exact test, of one side: the
/// probability of as many or more of all failures on the new side if they are equally probable.
/// Lost runs count as failures before and as none after, so that what is found is found in any
/// case. Both numbers of runs were fixed.
double fisher_worse(const RateCounts& before, const RateCounts& after);

/// The same for numbers of which one at least was not fixed, with bounds that hold whenever one
/// looks, each at 1 - (1-C)/2: does the lower one after lie above the upper one before? With at
/// most 1-C it does although the probability has not grown.
bool is_surely_worse(const RateCounts& before, const RateCounts& after, double confidence_level);

/// With this confidence, the probability after exceeds that before by less than this: the upper
/// bound after less the lower one before, each at 1 - (1-C)/2. Lost runs count as none before, as
/// failures after.
double excess_bound(const RateCounts& before, const RateCounts& after, double confidence_level);

}  // namespace parallax::harness
