#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace parallax::compiler {

/// A number of a plan: an exact rational with 64-bit parts where it fits, else a double. An
/// operation whose exact result does not fit falls back to double, so 1/3 + 1/6 is exactly 1/2 and
/// 2^62 * 4 is 1.8446744073709552e19. Inexactness never goes away again.
class Number {
 public:
  /// Type that `eql` distinguishes beside the value. A float was written with a point or an
  /// exponent, a double with `d`, or computed from such a number.
  enum class Kind : std::uint8_t { kRational, kSingle, kDouble };

  Number() = default;
  explicit Number(std::int64_t integer) : numerator_(integer), value_(as_double(integer)) {}
  static Number inexact(double value, Kind kind = Kind::kSingle);
  /// None for a zero denominator.
  static std::optional<Number> ratio(std::int64_t numerator, std::int64_t denominator);
  /// Reads `1`, `-0.2`, `1.`, `.5`, `0.75d0`, `1e-3`, `3/4`; exact if the digits and the power of
  /// ten fit 64 bits. `NotANumber` is any other token.
  enum class Parse : std::uint8_t { kNumber, kNotANumber, kOutOfRange, kZeroDenominator };
  static Parse parse(std::string_view token, Number& out);

  bool exact() const { return exact_; }
  Kind kind() const { return kind_; }
  bool is_float() const { return kind_ != Kind::kRational; }
  Number as_float(Kind kind = Kind::kSingle) const;
  bool is_integer() const { return exact_ && denominator_ == 1; }
  std::int64_t numerator() const { return numerator_; }      // exact numbers only
  std::int64_t denominator() const { return denominator_; }  // positive, coprime to the numerator
  double value() const { return value_; }

  /// Text that `parse` reads back as the same number.
  std::string to_string() const;
  friend bool operator==(const Number&, const Number&) = default;

 private:
  static double as_double(std::int64_t integer);
  bool exact_ = true;
  Kind kind_ = Kind::kRational;
  std::int64_t numerator_ = 0;
  std::int64_t denominator_ = 1;
  double value_ = 0.0;
};

Number operator+(const Number& a, const Number& b);
Number operator-(const Number& a, const Number& b);
Number operator*(const Number& a, const Number& b);
/// None for a zero divisor.
std::optional<Number> divide(const Number& a, const Number& b);
/// -1, 0 or 1 by value; exact if both are.
int compare(const Number& a, const Number& b);

}  // namespace parallax::compiler
