#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace parallax::harness {

/// A quantile of a distribution, estimated from independent values.
struct QuantileEstimate {
  double probability = 0.5;  // in (0, 1)
  double value = 0.0;        // the least value that this share of the values does not exceed
  /// Distribution-free interval between two order statistics. None: unbounded on that side.
  std::optional<double> lower, upper;
};

/// Mean and quantiles of a number that runs report, in its unit.
struct ValueSummary {
  std::int64_t count = 0;  // values
  double mean = 0.0;       // of them
  double sd = 0.0;         // standard deviation, with count - 1
  double least = 0.0, most = 0.0;
  /// Student's t interval of the mean, which supposes that means of as many values are about
  /// normal. None for fewer than two values, values that are all equal, or where none was asked
  /// for.
  std::optional<double> mean_lower, mean_upper;
  std::vector<QuantileEstimate> quantiles;
};

/// The ranks (from 1) of the order statistics of n independent values between which their quantile
/// lies with a probability of at least C, each end wrong with at most (1-C)/2. 0 or n + 1: no value
/// bounds it on that side. For any distribution, continuous or not.
struct QuantileRanks {
  std::int64_t lower = 0, upper = 0;
};
QuantileRanks quantile_ranks(std::int64_t n, double probability, double confidence_level);

/// Summarizes at least one value. `unknown` further runs may have had any value, or none: quantile
/// intervals allow for that, the mean is of the known values. The interval of each quantile in
/// `probabilities` and that of the mean hold with `confidence_level` each, for a number of runs
/// that was fixed in advance; without `confidence_level` there are none.
ValueSummary summarize_values(std::vector<double> values, std::int64_t unknown,
                              const std::vector<double>& probabilities,
                              std::optional<double> confidence_level);

}  // namespace parallax::harness
