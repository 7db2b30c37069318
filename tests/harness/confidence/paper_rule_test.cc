// The worked numbers of the paper's Examples 3 and 4, and of one further data set.
#include "harness/confidence/paper_rule.h"

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>

#include "harness/confidence/quantiles.h"
#include "harness/sampling/sampler.h"

namespace parallax::harness {
namespace {

constexpr double kTolerance = 1e-6;

void check_close(double actual, double expected, double tolerance = kTolerance) {
  CAPTURE(actual);
  CAPTURE(expected);
  CHECK(std::abs(actual - expected) <= tolerance);
}

void check_interval(const Interval& actual, double lower, double upper) {
  check_close(actual.lower, lower);
  check_close(actual.upper, upper);
}

const std::vector<Interval> kTwoRegions = {{0, 1}, {1, 2, true}};

RegressionInput example_3() {
  return {{{0.5, 1.3}, {0.9, 1.7}}, {{0.6}, {0.8}}, kTwoRegions, {Interval{0, 1}}, {}, {}};
}

RegressionInput own_case() {
  return {{{0.2, 1.1}, {0.4, 1.9}, {0.7, 1.5}, {0.9, 1.2}},
          {{0.45}, {0.55}, {0.62}, {0.71}},
          kTwoRegions,
          {Interval{0, 1}},
          {},
          {}};
}

PaperRuleSpec intercept_prediction() {
  PaperRuleSpec spec;
  spec.sigma = SigmaKind::kResidualSd;
  spec.intercept = InterceptKind::kFree;
  spec.interval = IntervalKind::kPrediction;
  spec.extra_runs = 2;
  return spec;
}

Eigen::MatrixXd matrix(const std::vector<std::vector<double>>& rows) {
  Eigen::MatrixXd result(std::ssize(rows), std::ssize(rows.front()));
  for (Eigen::Index i = 0; i < result.rows(); ++i) {
    for (Eigen::Index j = 0; j < result.cols(); ++j) {
      result(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    }
  }
  return result;
}

TEST_CASE("Example 3: the regression through two runs is exact") {
  const auto input = example_3();
  const auto x = matrix(input.x);
  const Eigen::VectorXd y = matrix(input.y).col(0);
  check_close(x.determinant(), -0.32);
  check_close((x.transpose() * x)(0, 0), 1.06);
  check_close((x.transpose() * x)(0, 1), 2.18);
  check_close((x.transpose() * x)(1, 1), 4.58);
  check_close((x.transpose() * y)(0), 1.02);
  check_close((x.transpose() * y)(1), 2.14);
  const auto fit = fit_line(x, y, false);
  REQUIRE(fit);
  check_close(fit->coefficients(0), 0.0625);
  check_close(fit->coefficients(1), 0.4375);
  check_close(fit->sse, 0.0, 1e-28);
  CHECK(fit->intercept == 0.0);
}

TEST_CASE("Example 3: read to the letter the rule stops after two runs, the preset does not") {
  auto spec = paper_literal();
  spec.extra_runs = 0;
  const auto verdict = paper_rule(example_3(), spec, 0.95);
  CHECK(verdict.stop);
  REQUIRE(verdict.intervals.size() == 1);
  check_interval({verdict.intervals[0].lower, verdict.intervals[0].upper}, 0.4375, 0.9375);
  check_close(verdict.z, 2.236477);

  const auto preset = paper_rule(example_3(), paper_literal(), 0.95);
  CHECK_FALSE(preset.stop);
  CHECK(preset.why_not == "2 runs, 3 needed at least");
}

TEST_CASE("Z: two-sided normal quantile of the n-th root of the confidence") {
  check_close(interval_level(0.95, 2, false), 0.974679);
  const auto z = [](double level, std::int64_t n) {
    return two_sided_z(interval_level(level, n, false));
  };
  check_close(z(0.95, 2), 2.236477);
  check_close(z(0.95, 1), 1.959964);
  check_close(z(0.95, 6), 2.631038);
  check_close(z(0.99, 2), 2.806225);
  check_close(z(0.99, 6), 3.142756);
  check_close(normal_quantile(std::sqrt(0.95)), 1.954508);            // one-sided, not meant
  check_close(two_sided_z(interval_level(0.95, 2, true)), 2.241403);  // Bonferroni
}

TEST_CASE("Example 4: the interval, with the printed Z and with the exact one") {
  const Eigen::Vector2d b(0.9, -0.1);
  check_interval(mean_interval(b, 0.0, kTwoRegions, 2.24, 0.3, 4), -0.536, 1.136);
  const double z = two_sided_z(interval_level(0.95, 2, false));
  check_interval(mean_interval(b, 0.0, kTwoRegions, z, 0.3, 4), -0.535471, 1.135471);
  // The prose's other coefficients do not give the printed result.
  check_interval(mean_interval(Eigen::Vector2d(0.5, -0.4), 0.0, kTwoRegions, 2.24, 0.3, 4), -1.136,
                 0.436);
}

TEST_CASE("Example 4: the readings of sigma") {
  const Eigen::Vector2d b(0.9, -0.1);
  const double z = two_sided_z(interval_level(0.95, 2, false));
  const auto with = [&](double sigma) { return mean_interval(b, 0.0, kTwoRegions, z, sigma, 4); };
  check_interval(with(sigma_of(SigmaKind::kSse, 0.3, 4, 2)), -0.535471, 1.135471);
  check_interval(with(sigma_of(SigmaKind::kRmse, 0.3, 4, 2)), -0.506242, 1.106242);
  check_interval(with(sigma_of(SigmaKind::kResidualSd, 0.3, 4, 2)), -0.633092, 1.233092);
  check_interval(with(std::sqrt(0.3)), -0.812484, 1.412484);
}

TEST_CASE("Example 4: the bare lower end lies outside already, so no number of runs can help") {
  const Eigen::Vector2d b(0.9, -0.1);
  CHECK(mean_interval(b, 0.0, kTwoRegions, 2.24, 0.0, 4).lower == doctest::Approx(-0.2));
  for (const std::int64_t runs : {10, 1000, 1000000}) {
    CHECK(mean_interval(b, 0.0, kTwoRegions, 2.24, 0.3, runs).lower < -0.2);
  }
}

TEST_CASE("own case: coefficients, SSE, bare interval and the paper's interval") {
  const auto verdict = paper_rule(own_case(), paper_literal(), 0.95);
  CHECK(verdict.stop);
  REQUIRE(verdict.intervals.size() == 1);
  const auto& interval = verdict.intervals[0];
  check_close(interval.coefficients[0], 0.46490672);
  check_close(interval.coefficients[1], 0.22046300);
  check_close(interval.sse, 0.0181559313);
  check_interval({interval.lower, interval.upper}, 0.20016034, 0.92613537);
  const Eigen::Vector2d b(interval.coefficients[0], interval.coefficients[1]);
  check_interval(mean_interval(b, 0.0, kTwoRegions, 0.0, 0.0, 4), 0.22046300, 0.90583271);
}

TEST_CASE("own case, intercept: coefficients, t quantile and prediction intervals at the corners") {
  const auto input = own_case();
  const auto fit = fit_line(matrix(input.x), matrix(input.y).col(0), true);
  REQUIRE(fit);
  check_close(fit->intercept, 0.34987919);
  check_close(fit->coefficients(0), 0.35234899);
  check_close(fit->coefficients(1), 0.02724832);
  check_close(fit->sse, 4.6389262e-4, 1e-11);
  CHECK(fit->degrees_of_freedom() == 1);

  const auto verdict = paper_rule(input, intercept_prediction(), 0.95);
  check_close(verdict.z, 25.12914, 1e-5);
  check_close(student_t_quantile(0.5 * (1 + std::sqrt(0.95)), 1), 25.12914, 1e-5);

  const double sigma = sigma_of(SigmaKind::kResidualSd, fit->sse, fit->runs, fit->parameters);
  const auto corner = [&](double x1, double x2) {
    return prediction_interval(*fit, Eigen::Vector2d(x1, x2), verdict.z, sigma);
  };
  check_interval(corner(0, 1), -0.540145, 1.294400);
  check_interval(corner(0, 2), -0.535480, 1.344232);
  check_interval(corner(1, 1), -0.097631, 1.556584);
  check_interval(corner(1, 2), -0.169081, 1.682531);

  // The rule takes the hull over the corners.
  REQUIRE(verdict.intervals.size() == 1);
  check_interval({verdict.intervals[0].lower, verdict.intervals[0].upper}, -0.540145, 1.682531);
  CHECK_FALSE(verdict.stop);
  CHECK(verdict.why_not == "`y1` may end in [-0.540145, 1.68253], its cell is [0, 1]");
}

TEST_CASE("prediction: the hull over the corners contains the interval of every point inside") {
  const auto input = own_case();
  const auto fit = fit_line(matrix(input.x), matrix(input.y).col(0), true);
  const auto verdict = paper_rule(input, intercept_prediction(), 0.95);
  const double sigma = sigma_of(SigmaKind::kResidualSd, fit->sse, fit->runs, fit->parameters);
  for (std::uint64_t k = 0; k < 500; ++k) {
    const CounterRng rng({.campaign_seed = 2, .sample = k});
    const auto at = prediction_interval(*fit, Eigen::Vector2d(rng.uniform(0), 1 + rng.uniform(1)),
                                        verdict.z, sigma);
    CHECK(at.lower >= verdict.intervals[0].lower);
    CHECK(at.upper <= verdict.intervals[0].upper);
  }
}

/// A fit of `parameters` starts in ranges of different widths to one noisy outcome.
LinearFit random_fit(std::size_t parameters, std::span<const Interval> range) {
  const auto runs = static_cast<Eigen::Index>(3 * parameters);
  Eigen::MatrixXd x(runs, static_cast<Eigen::Index>(parameters));
  Eigen::VectorXd y(runs);
  for (Eigen::Index row = 0; row < runs; ++row) {
    const CounterRng rng({.campaign_seed = 6, .sample = static_cast<std::uint64_t>(row)});
    for (std::size_t i = 0; i < parameters; ++i) {
      x(row, static_cast<Eigen::Index>(i)) = range[i].lower + range[i].width() * rng.uniform(i);
    }
    y(row) = x(row, 0) - 2.0 * x(row, x.cols() - 1) + 0.1 * rng.uniform(99);
  }
  return *fit_line(x, y, true);
}

std::vector<Interval> uneven_ranges(std::size_t parameters) {
  std::vector<Interval> range;
  for (std::size_t i = 0; i < parameters; ++i) {
    const auto size = static_cast<double>(i + 1);
    range.push_back({-0.3 * size, 0.2 * size * size});
  }
  return range;
}

/// The hull by visiting the corners in the order of their bits.
Interval corner_by_corner(const LinearFit& fit, std::span<const Interval> range, double q,
                          double sigma) {
  Interval hull{INFINITY, -INFINITY};
  Eigen::VectorXd corner(std::ssize(range));
  for (std::uint32_t mask = 0; mask < (1U << range.size()); ++mask) {
    for (std::size_t i = 0; i < range.size(); ++i) {
      corner(static_cast<Eigen::Index>(i)) =
          (mask >> i & 1U) != 0 ? range[i].upper : range[i].lower;
    }
    const auto at = prediction_interval(fit, corner, q, sigma);
    hull = {std::min(hull.lower, at.lower), std::max(hull.upper, at.upper)};
  }
  return hull;
}

TEST_CASE("prediction: up to sixteen parameters the hull is that of all corners") {
  for (const std::size_t parameters : {1U, 2U, 5U, 16U}) {
    CAPTURE(parameters);
    const auto range = uneven_ranges(parameters);
    const auto fit = random_fit(parameters, range);
    const auto hull = prediction_hull(fit, range, 3.0, 0.2);
    const auto expected = corner_by_corner(fit, range, 3.0, 0.2);
    check_close(hull.lower, expected.lower, 1e-9);
    check_close(hull.upper, expected.upper, 1e-9);
  }
}

TEST_CASE("prediction: beyond sixteen parameters the bound still contains the corners") {
  const auto range = uneven_ranges(17);
  const auto fit = random_fit(17, range);
  const auto bound = prediction_hull(fit, range, 3.0, 0.2);
  const auto hull = corner_by_corner(fit, range, 3.0, 0.2);
  CHECK(bound.lower <= hull.lower);
  CHECK(bound.upper >= hull.upper);
}

TEST_CASE("leverage: equals v'(D'D)^-1 v by inversion, with and without intercept") {
  const auto x = matrix(own_case().x);
  const Eigen::VectorXd y = matrix(own_case().y).col(0);
  Eigen::MatrixXd design(4, 3);
  design << Eigen::VectorXd::Ones(4), x;
  const Eigen::Vector2d v(0.3, 1.8);
  const Eigen::Vector3d v1(1.0, 0.3, 1.8);
  check_close(fit_line(x, y, false)->leverage(v), v.dot((x.transpose() * x).inverse() * v), 1e-12);
  check_close(fit_line(x, y, true)->leverage(v),
              v1.dot((design.transpose() * design).inverse() * v1), 1e-11);
}

TEST_CASE("presets: as the table of readings has them") {
  const auto literal = paper_literal();
  CHECK(literal.sigma == SigmaKind::kSse);
  CHECK(literal.root == RootKind::kInitial);
  CHECK(literal.intercept == InterceptKind::kNone);
  CHECK(literal.interval == IntervalKind::kMean);
  CHECK(literal.extra_runs == 1);
  CHECK(literal.tolerance_m == 0.0);
  const auto repaired = paper_repaired();
  CHECK(repaired.sigma == SigmaKind::kResidualSd);
  CHECK(repaired.root == RootKind::kFinal);
  CHECK(repaired.intercept == InterceptKind::kFree);
  CHECK(repaired.interval == IntervalKind::kPrediction);
  CHECK(repaired.extra_runs == 2);
  CHECK(repaired.exempt_inherited);
  CHECK(repaired.tolerance_m == 0.01);
}

}  // namespace
}  // namespace parallax::harness
