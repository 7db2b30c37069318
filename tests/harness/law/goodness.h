#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

namespace parallax::harness::test {

/// sqrt(n) times the greatest distance of the values from a distribution function (Kolmogorov).
/// A correct program exceeds 2.7 once in a million times: 2 exp(-2 * 2.7^2).
inline double kolmogorov(std::vector<double> values, const std::function<double(double)>& cdf) {
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  double most = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double expected = cdf(values[i]);
    most = std::max(
        {most, static_cast<double>(i + 1) / n - expected, expected - static_cast<double>(i) / n});
  }
  return most * std::sqrt(n);
}
inline constexpr double kKolmogorovLimit = 2.7;

/// Standard deviations of Pearson's statistic beyond its mean, by Wilson and Hilferty's cube root.
/// Above 5 once in three million times.
inline double chi_square_excess(const std::vector<std::int64_t>& counts,
                                const std::vector<double>& shares) {
  std::int64_t n = 0;
  for (const auto count : counts) n += count;
  double statistic = 0.0;
  double cells = 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double expected = shares[i] * static_cast<double>(n);
    if (expected < 5.0) continue;  // too few for the approximation
    const double off = static_cast<double>(counts[i]) - expected;
    statistic += off * off / expected;
    cells += 1.0;
  }
  const double freedom = cells - 1.0;
  const double spread = 2.0 / (9.0 * freedom);
  return (std::cbrt(statistic / freedom) - (1.0 - spread)) / std::sqrt(spread);
}
inline constexpr double kChiSquareLimit = 5.0;

/// Simpson's rule.
inline double integral(const std::function<double(double)>& f, double from, double to,
                       int steps = 2000) {
  const double h = (to - from) / steps;
  double sum = f(from) + f(to);
  for (int i = 1; i < steps; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * f(from + i * h);
  return sum * h / 3.0;
}

}  // namespace parallax::harness::test
