// Affine arithmetic (Stolfi and de Figueiredo 1997) with a fixed set of symbols and outward
// rounding.
//
// A value is a centre, a slope for each variable and a rest: it lies within centre + sum(slope
// e) +- rest for all e in [-1, 1]. Sums and differences are exact but for rounding; of a
// product, the terms that are linear in the variables are kept, and what is quadratic goes into
// the rest. A function becomes its tangent (for an absolute value that changes sign, the chord),
// with a bound on the distance added to the rest. Every operation adds what rounding may have
// lost, taken twice as large as it is. So bounds are always valid, and unlike intervals they do
// not lose that two values depend on the same variable.
//
// Cost: linear in the variables for each operation; the overestimate shrinks with the square of
// the box.

#include "harness/geometry_proof/affine_form.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "compiler/base/contract.h"

namespace parallax::harness {
namespace {

/// Twice what rounding one operation may lose, relatively; the surplus covers the sums in which
/// such losses are added up.
constexpr double kUnit = 2.0 * std::numeric_limits<double>::epsilon();
constexpr double kTiny = std::numeric_limits<double>::min();
/// The sine and cosine of the C library are off by less than this.
constexpr double kTrigonometry = 4.0 * std::numeric_limits<double>::epsilon();

/// An upper bound of the exact sum, given the rounded sum of a few non-negative terms.
double up(double sum) { return sum + sum * 64.0 * kUnit + kTiny; }

}  // namespace

AffineForm AffineForm::variable(std::size_t index, double lower, double upper) {
  PARALLAX_REQUIRE(index < kMostVariables && lower <= upper, "a variable with bounds in order");
  AffineForm x(0.5 * lower + 0.5 * upper);
  const double radius = up(std::max(upper - x.center_, x.center_ - lower));
  x.slopes_[index] = radius;
  x.used_ = index + 1;
  x.rest_ = up(kUnit * std::abs(x.center_));
  return x;
}

AffineForm AffineForm::within(double center, double radius) {
  AffineForm x(center);
  x.rest_ = radius;
  return x;
}

double AffineForm::radius() const {
  double sum = rest_;
  for (std::size_t i = 0; i < used_; ++i) sum += std::abs(slopes_[i]);
  return up(sum);
}

double AffineForm::lower() const {
  const double bound = center_ - radius();
  return bound - kUnit * std::abs(bound) - kTiny;
}

double AffineForm::upper() const {
  const double bound = center_ + radius();
  return bound + kUnit * std::abs(bound) + kTiny;
}

AffineForm AffineForm::operator-() const {
  AffineForm x = *this;
  x.center_ = -center_;
  for (std::size_t i = 0; i < used_; ++i) x.slopes_[i] = -slopes_[i];
  return x;
}

AffineForm& AffineForm::operator+=(const AffineForm& other) {
  center_ += other.center_;
  double lost = std::abs(center_);
  used_ = std::max(used_, other.used_);
  for (std::size_t i = 0; i < used_; ++i) {
    slopes_[i] += other.slopes_[i];
    lost += std::abs(slopes_[i]);
  }
  rest_ = up(rest_ + other.rest_ + kUnit * lost);
  return *this;
}

AffineForm operator*(const AffineForm& a, const AffineForm& b) {
  AffineForm x(a.center_ * b.center_);
  x.used_ = std::max(a.used_, b.used_);
  double lost = std::abs(x.center_);
  double radius_a = a.rest_, radius_b = b.rest_;
  for (std::size_t i = 0; i < x.used_; ++i) {
    const double from_a = a.slopes_[i] * b.center_, from_b = b.slopes_[i] * a.center_;
    x.slopes_[i] = from_a + from_b;
    lost += std::abs(from_a) + std::abs(from_b);
    radius_a += std::abs(a.slopes_[i]);
    radius_b += std::abs(b.slopes_[i]);
  }
  x.rest_ = up(up(radius_a) * up(radius_b) + a.rest_ * std::abs(b.center_) +
               b.rest_ * std::abs(a.center_) + kUnit * lost);
  return x;
}

AffineForm AffineForm::linear(const AffineForm& x, double value, double slope, double error) {
  AffineForm y(value);
  y.used_ = x.used_;
  double lost = std::abs(value);
  for (std::size_t i = 0; i < x.used_; ++i) {
    y.slopes_[i] = slope * x.slopes_[i];
    lost += std::abs(y.slopes_[i]);
  }
  y.rest_ = up(std::abs(slope) * x.rest_ + error + kUnit * lost);
  return y;
}

namespace {

/// The greatest distance of a sine from its tangent within `radius`: its second derivative is at
/// most 1, and both stay within reach of each other.
double sine_error(double radius) {
  return up(std::min(0.5 * radius * radius, 2.0 + radius) + kTrigonometry * (1.0 + radius));
}

}  // namespace

AffineForm sine(const AffineForm& x) {
  const double radius = x.radius();
  if (!(radius < 1.5)) return AffineForm::within(0.0, 1.0);
  return AffineForm::linear(x, std::sin(x.center_), std::cos(x.center_), sine_error(radius));
}

AffineForm cosine(const AffineForm& x) {
  const double radius = x.radius();
  if (!(radius < 1.5)) return AffineForm::within(0.0, 1.0);
  return AffineForm::linear(x, std::cos(x.center_), -std::sin(x.center_), sine_error(radius));
}

AffineForm root(const AffineForm& x) {
  const double high = x.upper();
  PARALLAX_REQUIRE(high >= 0.0, "a form that is not negative throughout");
  const double low = x.lower();
  // Near 0 the tangent is of no use.
  if (low <= 0.01 * high) {
    const double half = up(0.5 * std::sqrt(high));
    return AffineForm::within(half, half);
  }
  const double value = std::sqrt(x.center_), radius = x.radius();
  const double curvature = 0.25 / (low * std::sqrt(low));
  return AffineForm::linear(x, value, 0.5 / value,
                            up(0.5 * curvature * radius * radius * 1.001 + kUnit * value));
}

AffineForm absolute(const AffineForm& x) {
  const double low = x.lower(), high = x.upper();
  if (low >= 0.0) return x;
  if (high <= 0.0) return -x;
  // The chord over [low, high] lies above by 0 to `most`, which it does at 0.
  const double slope = (high + low) / (high - low);
  const double most = -2.0 * low * high / (high - low);
  const double value = -low + slope * (x.center_ - low) - 0.5 * most;
  const double lost = kUnit * 8.0 * (std::abs(low) + std::abs(high));
  return AffineForm::linear(x, value, slope, up(0.5 * most + lost));
}

}  // namespace parallax::harness
