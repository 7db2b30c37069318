#pragma once

#include <array>
#include <cstddef>

namespace parallax::harness {

/// A closed interval that is certain to contain a value.
struct Bounds1 {
  double lower = 0.0, upper = 0.0;
  friend bool operator==(const Bounds1&, const Bounds1&) = default;
};

/// A value that depends on variables: somewhere in `center + sum(slope_i e_i) + [-rest, rest]` for
/// each choice of the e_i in [-1, 1]. Every operation is rounded outwards: what is lost to rounding
/// and to what is not linear goes into `rest`. Affine arithmetic (Stolfi and de Figueiredo 1997)
/// with a fixed set of symbols: the overestimate shrinks with the square of the box.
class AffineForm {
 public:
  static constexpr std::size_t kMostVariables = 32;

  AffineForm(double constant = 0.0) : center_(constant) {}  // NOLINT: numbers are forms
  /// Variable `index` in [lower, upper].
  static AffineForm variable(std::size_t index, double lower, double upper);
  /// Anything within `radius` of `center`, whatever the variables are.
  static AffineForm within(double center, double radius);

  double lower() const;
  double upper() const;
  Bounds1 bounds() const { return {lower(), upper()}; }
  double center() const { return center_; }
  double slope(std::size_t index) const { return slopes_[index]; }
  double rest() const { return rest_; }
  double radius() const;  // rounded up

  AffineForm operator-() const;
  AffineForm& operator+=(const AffineForm& other);
  AffineForm& operator-=(const AffineForm& other) { return *this += -other; }
  friend AffineForm operator+(AffineForm a, const AffineForm& b) { return a += b; }
  friend AffineForm operator-(AffineForm a, const AffineForm& b) { return a -= b; }
  friend AffineForm operator*(const AffineForm& a, const AffineForm& b);

  friend AffineForm sine(const AffineForm& x);
  friend AffineForm cosine(const AffineForm& x);
  /// The square root of the non-negative part of `x`; that part must not be empty.
  friend AffineForm root(const AffineForm& x);
  friend AffineForm absolute(const AffineForm& x);

 private:
  /// `value + slope (x - x.center)`, off by at most `error`.
  static AffineForm linear(const AffineForm& x, double value, double slope, double error);

  double center_ = 0.0;
  std::size_t used_ = 0;  // slopes beyond are 0
  std::array<double, kMostVariables> slopes_{};
  double rest_ = 0.0;
};

AffineForm operator*(const AffineForm& a, const AffineForm& b);
AffineForm sine(const AffineForm& x);
AffineForm cosine(const AffineForm& x);
AffineForm root(const AffineForm& x);
AffineForm absolute(const AffineForm& x);

}  // namespace parallax::harness
