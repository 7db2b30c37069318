// The intervals of the paper's rule: quantiles, readings of sigma, the mean's interval, and the
// prediction intervals over a whole cuboid of starts. Both ends of these are extreme at corners:
// the mean is linear and the half-width convex in x.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "compiler/base/contract.h"
#include "harness/confidence/paper_rule.h"
#include "harness/confidence/quantiles.h"

namespace parallax::harness {
namespace {

/// Beyond this many parameters the 2^n corners are bounded instead of visited.
constexpr std::size_t kMaxCornerParameters = 16;

Eigen::VectorXd lowest_corner(std::span<const Interval> range) {
  Eigen::VectorXd corner(std::ssize(range));
  for (std::size_t j = 0; j < range.size(); ++j) {
    corner(static_cast<Eigen::Index>(j)) = range[j].lower;
  }
  return corner;
}

/// Visits the corners in the order of a Gray code: from one to the next a single coordinate
/// changes, so mean and leverage follow in k steps instead of k^2.
Interval hull_of_corners(const LinearFit& fit, std::span<const Interval> range, double q,
                         double sigma) {
  const Eigen::Index lead = fit.has_intercept ? 1 : 0;
  const Eigen::VectorXd start = lowest_corner(range);
  double mean = fit.at(start);
  Eigen::VectorXd leverage_root = fit.half_inverse.rightCols(start.size()) * start;
  if (fit.has_intercept) leverage_root += fit.half_inverse.col(0);
  Interval hull;
  const std::uint32_t corners = 1U << range.size();
  for (std::uint32_t visited = 0;;) {
    const double half_width = q * sigma * std::sqrt(1.0 + leverage_root.squaredNorm());
    hull.lower = visited == 0 ? mean - half_width : std::min(hull.lower, mean - half_width);
    hull.upper = visited == 0 ? mean + half_width : std::max(hull.upper, mean + half_width);
    if (++visited == corners) return hull;
    const auto j = static_cast<std::size_t>(std::countr_zero(visited));
    const std::uint32_t gray = visited ^ (visited >> 1U);
    const double step = (gray >> j & 1U) != 0 ? range[j].width() : -range[j].width();
    mean += step * fit.coefficients(static_cast<Eigen::Index>(j));
    leverage_root += step * fit.half_inverse.col(lead + static_cast<Eigen::Index>(j));
  }
}

/// Never shorter than the hull: the mean's extremes by the signs of its coefficients, and the
/// leverage's square root bounded by the triangle inequality from the midpoint outwards.
Interval bound_of_corners(const LinearFit& fit, std::span<const Interval> range, double q,
                          double sigma) {
  Eigen::VectorXd middle(std::ssize(range));
  const Eigen::Index lead = fit.has_intercept ? 1 : 0;
  double reach = 0.0;
  for (std::size_t j = 0; j < range.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    middle(column) = range[j].midpoint();
    reach += 0.5 * range[j].width() * fit.half_inverse.col(lead + column).norm();
  }
  reach += std::sqrt(fit.leverage(middle));
  const Interval mean = mean_interval(fit.coefficients, fit.intercept, range, 0.0, 0.0, 1);
  const double half_width = q * sigma * std::sqrt(1.0 + reach * reach);
  return {mean.lower - half_width, mean.upper + half_width, true};
}

}  // namespace

Interval prediction_interval(const LinearFit& fit, const Eigen::VectorXd& x, double q,
                             double sigma) {
  const double half_width = q * sigma * std::sqrt(1.0 + fit.leverage(x));
  return {fit.at(x) - half_width, fit.at(x) + half_width, true};
}

Interval prediction_hull(const LinearFit& fit, std::span<const Interval> range, double q,
                         double sigma) {
  return range.size() > kMaxCornerParameters ? bound_of_corners(fit, range, q, sigma)
                                             : hull_of_corners(fit, range, q, sigma);
}

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
