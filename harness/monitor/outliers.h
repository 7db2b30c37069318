#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

namespace parallax::harness {

/// Number of observations that may be wrong: at most `at_most` of any `of` compared ones in a row.
struct OutlierRate {
  std::int64_t at_most = 0, of = 1;
  bool is_none() const { return at_most == 0; }
};

/// Reads "2/100"; a reason why it is not a rate otherwise.
std::optional<OutlierRate> read_outlier_rate(std::string_view text);

/// Counts the observations of a log that no possible state agrees with.
///
/// A rate alone would hide a real discrepancy that is seen once, since many logs have one
/// observation between two steps. So there is a second rule: between two steps more observations
/// agree than do not.
class OutlierCount {
 public:
  explicit OutlierCount(const OutlierRate& rate) : rate_(rate) {}

  /// A compared observation agrees with a possible state.
  void agreed();
  /// One does not. False: the rate allows no more.
  bool disagreed();
  /// A step follows, or the log ends. False: in the stretch before it no more observations agreed
  /// than did not. Starts the next stretch.
  bool end_stretch();

  std::int64_t count() const { return count_; }  // outliers so far
  /// Is this the first one since the last step?
  bool is_first_of_stretch() const { return stretch_outliers_ == 1; }

 private:
  OutlierRate rate_;
  std::int64_t seen_ = 0, count_ = 0, stretch_agreed_ = 0, stretch_outliers_ = 0;
  std::deque<std::int64_t> recent_;  // numbers of the last `at_most` outliers
};

}  // namespace parallax::harness
