// Distribution functions and their inverses, to about 1e-10.
//
// The normal quantile is Wichura's rational approximation (1988, AS 241) with one Newton step.
// The incomplete beta function is its continued fraction, evaluated by Lentz's method on the
// side where it converges fast, and by symmetry on the other; Student's t follows from it.
// Inverses take Newton steps inside a bracket that shrinks around the root, and halve the
// bracket where a step would leave it, so they always end. Tails are computed by themselves, not
// as one minus the rest, where that would cancel.

#include "harness/confidence/quantiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "compiler/base/contract.h"

namespace parallax::harness {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// Value of the polynomial with `c` in ascending powers (Horner).
double polynomial(const std::array<double, 8>& c, double x) {
  double value = 0.0;
  for (auto it = c.rbegin(); it != c.rend(); ++it) value = value * x + *it;
  return value;
}

// Wichura 1988, AS 241, PPND16: numerators and denominators of the centre, the flank and the tail.
constexpr std::array<double, 8> kCentreTop = {3.3871328727963666080e0, 1.3314166789178437745e2,
                                              1.9715909503065514427e3, 1.3731693765509461125e4,
                                              4.5921953931549871457e4, 6.7265770927008700853e4,
                                              3.3430575583588128105e4, 2.5090809287301226727e3};
constexpr std::array<double, 8> kCentreBottom = {1.0,
                                                 4.2313330701600911252e1,
                                                 6.8718700749205790830e2,
                                                 5.3941960214247511077e3,
                                                 2.1213794301586595867e4,
                                                 3.9307895800092710610e4,
                                                 2.8729085735721942674e4,
                                                 5.2264952788528545610e3};
constexpr std::array<double, 8> kFlankTop = {1.42343711074968357734e0,  4.63033784615654529590e0,
                                             5.76949722146069140550e0,  3.64784832476320460504e0,
                                             1.27045825245236838258e0,  2.41780725177450611770e-1,
                                             2.27238449892691845833e-2, 7.74545014278341407640e-4};
constexpr std::array<double, 8> kFlankBottom = {1.0,
                                                2.05319162663775882187e0,
                                                1.67638483018380384940e0,
                                                6.89767334985100004550e-1,
                                                1.48103976427480074590e-1,
                                                1.51986665636164571966e-2,
                                                5.47593808499534494600e-4,
                                                1.05075007164441684324e-9};
constexpr std::array<double, 8> kTailTop = {6.65790464350110377720e0,  5.46378491116411436990e0,
                                            1.78482653991729133580e0,  2.96560571828504891230e-1,
                                            2.65321895265761230930e-2, 1.24266094738807843860e-3,
                                            2.71155556874348757815e-5, 2.01033439929228813265e-7};
constexpr std::array<double, 8> kTailBottom = {1.0,
                                               5.99832206555887937690e-1,
                                               1.36929880922735805310e-1,
                                               1.48753612908506148525e-2,
                                               7.86869131145613259100e-4,
                                               1.84631831751005468180e-5,
                                               1.42151175831644588870e-7,
                                               2.04426310338993978564e-15};

/// The rational approximation for the lower half, p in (0, 0.5].
double lower_normal_quantile(double p) {
  constexpr double kCentre = 0.425, kSplit = 5.0, kShift = 1.6;
  const double q = p - 0.5;
  if (std::abs(q) <= kCentre) {
    const double r = kCentre * kCentre - q * q;
    return q * polynomial(kCentreTop, r) / polynomial(kCentreBottom, r);
  }
  const double r = std::sqrt(-std::log(p));
  if (r <= kSplit) {
    return -polynomial(kFlankTop, r - kShift) / polynomial(kFlankBottom, r - kShift);
  }
  return -polynomial(kTailTop, r - kSplit) / polynomial(kTailBottom, r - kSplit);
}

/// The root of an increasing function in [low, high]: Newton steps, bisection where one leaves the
/// bracket that shrinks around the root.
template <typename Function, typename Slope>
double increasing_root(Function value_at, Slope slope_at, double low, double high) {
  constexpr int kMaxSteps = 2000;  // bisection from 1 down to the least double takes 1074
  double x = 0.5 * (low + high);
  for (int step = 0; step < kMaxSteps; ++step) {
    const double value = value_at(x);
    if (value == 0.0) return x;
    (value < 0.0 ? low : high) = x;
    double next = x - value / slope_at(x);
    // Also catches a slope of zero and a Newton step that is not a number.
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - x) <= kEpsilon * std::abs(next) || next == low || next == high) return next;
    x = next;
  }
  return x;
}

/// P(T > t) for t >= 0, without cancellation in either regime.
double student_t_tail(double t, double dof) {
  const double square = t * t;
  if (square < dof) return 0.5 - 0.5 * incomplete_beta(0.5, 0.5 * dof, square / (dof + square));
  return 0.5 * incomplete_beta(0.5 * dof, 0.5, dof / (dof + square));
}

}  // namespace

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

double normal_quantile(double p) {
  PARALLAX_REQUIRE(p > 0.0 && p < 1.0, "a probability strictly between 0 and 1");
  if (p > 0.5) return -normal_quantile(1.0 - p);  // exact: 1 - p has no rounding here
  const double z = lower_normal_quantile(p);
  const double density = std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
  if (density < std::numeric_limits<double>::min()) return z;
  return z - (normal_cdf(z) - p) / density;
}

double log_beta(double a, double b) { return std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b); }

double incomplete_beta_fraction(double a, double b, double x) {
  constexpr double kTiny = 1e-300;
  constexpr int kMaxTerms = 100000;
  const auto away_from_zero = [](double v) { return std::abs(v) < kTiny ? kTiny : v; };
  double c = 1.0;
  double d = 1.0 / away_from_zero(1.0 - (a + b) * x / (a + 1.0));
  double fraction = d;
  for (int m = 1; m < kMaxTerms; ++m) {
    const double even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
    d = 1.0 / away_from_zero(1.0 + even * d);
    c = away_from_zero(1.0 + even / c);
    fraction *= c * d;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
    d = 1.0 / away_from_zero(1.0 + odd * d);
    c = away_from_zero(1.0 + odd / c);
    fraction *= c * d;
    if (std::abs(c * d - 1.0) <= kEpsilon) break;
  }
  return fraction;
}

double incomplete_beta(double a, double b, double x) {
  PARALLAX_REQUIRE(a > 0.0 && b > 0.0 && x >= 0.0 && x <= 1.0, "a, b > 0 and x in [0, 1]");
  if (x == 0.0 || x == 1.0) return x;
  const double front = std::exp(a * std::log(x) + b * std::log1p(-x) - log_beta(a, b));
  if (x < (a + 1.0) / (a + b + 2.0)) return front * incomplete_beta_fraction(a, b, x) / a;
  return 1.0 - front * incomplete_beta_fraction(b, a, 1.0 - x) / b;
}

double beta_quantile(double p, double a, double b) {
  PARALLAX_REQUIRE(p >= 0.0 && p <= 1.0, "a probability");
  PARALLAX_REQUIRE(a > 0.0 && b > 0.0, "positive shape parameters");
  if (p == 0.0 || p == 1.0) return p;
  const double log_norm = log_beta(a, b);
  return increasing_root(
      [&](double x) { return incomplete_beta(a, b, x) - p; },
      [&](double x) {
        return std::exp((a - 1.0) * std::log(x) + (b - 1.0) * std::log1p(-x) - log_norm);
      },
      0.0, 1.0);
}

double binomial_at_most(std::int64_t k, std::int64_t n, double p) {
  if (k >= n) return 1.0;
  if (k < 0) return 0.0;
  return incomplete_beta(static_cast<double>(n - k), static_cast<double>(k) + 1.0, 1.0 - p);
}

double binomial_at_least(std::int64_t k, std::int64_t n, double p) {
  if (k <= 0) return 1.0;
  if (k > n) return 0.0;
  return incomplete_beta(static_cast<double>(k), static_cast<double>(n - k) + 1.0, p);
}

double student_t_cdf(double t, double degrees_of_freedom) {
  PARALLAX_REQUIRE(degrees_of_freedom > 0.0, "positive degrees of freedom");
  const double tail = student_t_tail(std::abs(t), degrees_of_freedom);
  return t > 0.0 ? 1.0 - tail : tail;
}

double student_t_quantile(double p, double degrees_of_freedom) {
  PARALLAX_REQUIRE(p > 0.0 && p < 1.0, "a probability strictly between 0 and 1");
  PARALLAX_REQUIRE(degrees_of_freedom > 0.0, "positive degrees of freedom");
  const double dof = degrees_of_freedom;
  const double tail = std::min(p, 1.0 - p);
  if (tail == 0.5) return 0.0;
  double high = 1.0;
  while (student_t_tail(high, dof) > tail) high *= 2.0;
  const double log_norm = log_beta(0.5 * dof, 0.5) + 0.5 * std::log(dof);
  const double t = increasing_root(
      [&](double x) { return tail - student_t_tail(x, dof); },
      [&](double x) { return std::exp(-0.5 * (dof + 1.0) * std::log1p(x * x / dof) - log_norm); },
      0.0, high);
  return p < 0.5 ? -t : t;
}

}  // namespace parallax::harness
