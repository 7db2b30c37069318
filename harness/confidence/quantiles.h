#pragma once

#include <cstdint>

namespace parallax::harness {

/// All to about 1e-10 or better, relative to the quantile and to the smaller tail.

/// Standard normal distribution function.
double normal_cdf(double z);
/// The inverse of normal_cdf for p in (0, 1): Wichura 1988, algorithm AS 241 (PPND16), and one
/// Newton step.
double normal_quantile(double p);

/// Regularized incomplete beta function I_x(a, b) for a, b > 0 and x in [0, 1], by Lentz's
/// evaluation of its continued fraction.
double incomplete_beta(double a, double b, double x);
/// The continued fraction alone: I_x(a, b) = x^a (1-x)^b / (a B(a, b)) * fraction. Converges fast
/// for x < (a + 1) / (a + b + 2).
double incomplete_beta_fraction(double a, double b, double x);
/// ln B(a, b).
double log_beta(double a, double b);
/// The x with I_x(a, b) = p, p in [0, 1].
double beta_quantile(double p, double a, double b);

/// P(X <= k) and P(X >= k) for X binomial, n draws with probability p in [0, 1].
double binomial_at_most(std::int64_t k, std::int64_t n, double p);
double binomial_at_least(std::int64_t k, std::int64_t n, double p);

/// Student's t with `degrees_of_freedom` > 0.
double student_t_cdf(double t, double degrees_of_freedom);
/// The inverse of student_t_cdf for p in (0, 1).
double student_t_quantile(double p, double degrees_of_freedom);

}  // namespace parallax::harness
