// The intervals of the paper's rule: quantiles, readings of sigma, the mean's interval.
#include <cmath>

#include "compiler/base/contract.h"
#include "harness/confidence/paper_rule.h"
#include "harness/confidence/quantiles.h"

namespace parallax::harness {

double interval_level(double confidence_level, std::int64_t count, bool bonferroni) {
  PARALLAX_REQUIRE(confidence_level > 0.0 && confidence_level < 1.0, "a confidence in (0, 1)");
  PARALLAX_REQUIRE(count > 0, "at least one interval");
  const auto intervals = static_cast<double>(count);
  if (bonferroni) return 1.0 - (1.0 - confidence_level) / intervals;
  return std::pow(confidence_level, 1.0 / intervals);
}

double two_sided_z(double level) { return normal_quantile(0.5 * (1.0 + level)); }

double sigma_of(SigmaKind kind, double sse, std::int64_t runs, std::int64_t parameters) {
  switch (kind) {
    case SigmaKind::kSse:
      return sse;
    case SigmaKind::kRmse:
      return std::sqrt(sse / static_cast<double>(runs));
    case SigmaKind::kResidualSd:
      PARALLAX_REQUIRE(runs > parameters, "more runs than coefficients");
      return std::sqrt(sse / static_cast<double>(runs - parameters));
  }
  return sse;
}

Interval mean_interval(const Eigen::VectorXd& coefficients, double intercept,
                       std::span<const Interval> x_range, double z, double sigma,
                       std::int64_t runs) {
  PARALLAX_REQUIRE(coefficients.size() == std::ssize(x_range), "one range per coefficient");
  double lower = intercept, upper = intercept;
  for (Eigen::Index i = 0; i < coefficients.size(); ++i) {
    const Interval& range = x_range[static_cast<std::size_t>(i)];
    const double b = coefficients(i);
    lower += b * (b > 0.0 ? range.lower : range.upper);
    upper += b * (b > 0.0 ? range.upper : range.lower);
  }
  const double half_width = z * sigma / std::sqrt(static_cast<double>(runs));
  return {lower - half_width, upper + half_width, true};
}

}  // namespace parallax::harness
