// Lisp's numbers as exact fractions for as long as they fit into 64 bits.
//
// A number is a numerator and a denominator in lowest terms and says whether Lisp would call it
// a rational, a single or a double. Decimal fractions are exact as well, so 0.1 and 0.2 make 0.3
// and plans do not depend on rounding. The kind of a result is the widest of its operands'.
// Every operation checks for overflow; where the exact result does not fit it goes on as a
// double, of the kind single at least. Fractions are compared by cross-multiplication.
//
// Cost: one greatest common divisor for each operation.

#include "compiler/lisp/number.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <numeric>

#include "compiler/base/ascii.h"
#include "compiler/base/whole_number.h"

namespace parallax::compiler {
namespace {

constexpr std::int64_t kMin = std::numeric_limits<std::int64_t>::min();
// 10^18 is the largest power of ten in 64 bits.
constexpr std::int64_t kMaxExponent = 18;

/// The parts of a decimal token; `digits` has no point.
struct Decimal {
  bool negative = false;
  std::string digits;
  std::int64_t fraction_digits = 0;
  std::int64_t exponent = 0;
  bool has_exponent = false;
  bool is_double = false;
};

bool read_exponent(std::string_view text, std::int64_t& exponent) {
  std::string_view digits = text;
  if (!digits.empty() && (digits.front() == '+' || digits.front() == '-')) digits.remove_prefix(1);
  if (!text.empty() && text.front() == '+') text = digits;  // from_chars knows no plus sign
  if (digits.empty()) return false;
  for (const char c : digits) {
    if (!base::is_digit(c)) return false;
  }
  // Whatever does not fit is far beyond the range of a double.
  exponent =
      base::whole_number<std::int64_t>(text).value_or(text.front() == '-' ? -100000 : 100000);
  exponent = std::clamp<std::int64_t>(exponent, -100000, 100000);
  return true;
}

/// Splits `[sign] digits [. digits] [exponent]`; false if the token has another shape.
bool split_decimal(std::string_view token, Decimal& out) {
  if (!token.empty() && (token.front() == '+' || token.front() == '-')) {
    out.negative = token.front() == '-';
    token.remove_prefix(1);
  }
  std::size_t i = 0;
  std::size_t whole = 0;
  for (; i < token.size() && base::is_digit(token[i]); ++i, ++whole) out.digits += token[i];
  if (i < token.size() && token[i] == '.') {
    for (++i; i < token.size() && base::is_digit(token[i]); ++i, ++out.fraction_digits) {
      out.digits += token[i];
    }
  }
  if (out.digits.empty()) return false;
  if (i == token.size()) return true;
  constexpr std::string_view kMarkers = "eEdDfFsSlL";
  if (kMarkers.find(token[i]) == std::string_view::npos) return false;
  out.has_exponent = true;
  constexpr std::string_view kDoubles = "dDlL";
  out.is_double = kDoubles.find(token[i]) != std::string_view::npos;
  return read_exponent(token.substr(i + 1), out.exponent);
}

/// `-0.25` for -25 and two places; always with a point.
std::string decimal_text(std::int64_t digits, int places) {
  if (places == 0) return fmt::format("{}.0", digits);
  auto text = fmt::format("{}", digits);
  const std::string sign = digits < 0 ? "-" : "";
  text.erase(0, sign.size());
  const auto after = static_cast<std::size_t>(places);
  if (text.size() <= after) text.insert(0, after + 1 - text.size(), '0');
  text.insert(text.size() - after, ".");
  return sign + text;
}

bool power_of_ten(std::int64_t exponent, std::int64_t& out) {
  if (exponent < 0 || exponent > kMaxExponent) return false;
  out = 1;
  while (exponent-- > 0) out *= 10;
  return true;
}

std::optional<Number> exact_decimal(const Decimal& decimal) {
  const auto digits = base::whole_number<std::int64_t>(decimal.digits);
  if (!digits) return std::nullopt;
  const auto mantissa = decimal.negative ? -*digits : *digits;
  const std::int64_t exponent = decimal.exponent - decimal.fraction_digits;
  std::int64_t scale = 1;
  if (exponent < 0) {
    if (!power_of_ten(-exponent, scale)) return std::nullopt;
    return Number::ratio(mantissa, scale);
  }
  std::int64_t product = 0;
  if (!power_of_ten(exponent, scale) || __builtin_mul_overflow(mantissa, scale, &product)) {
    return std::nullopt;
  }
  return Number(product);
}

Number::Parse parse_ratio(std::string_view token, std::size_t slash, Number& out) {
  auto top = token.substr(0, slash);
  const auto bottom = token.substr(slash + 1);
  const bool plus = !top.empty() && top.front() == '+';
  if (plus) top.remove_prefix(1);
  const auto digits = [](std::string_view text) {
    for (const char c : text) {
      if (!base::is_digit(c)) return false;
    }
    return !text.empty();
  };
  const bool minus = !plus && !top.empty() && top.front() == '-';
  if (!digits(minus ? top.substr(1) : top) || !digits(bottom)) return Number::Parse::kNotANumber;
  const auto numerator = base::whole_number<std::int64_t>(top);
  const auto denominator = base::whole_number<std::int64_t>(bottom);
  if (!numerator || !denominator || *numerator == kMin) return Number::Parse::kOutOfRange;
  const auto result = Number::ratio(*numerator, *denominator);
  if (!result) return Number::Parse::kZeroDenominator;
  out = *result;
  return Number::Parse::kNumber;
}

}  // namespace

double Number::as_double(std::int64_t integer) { return static_cast<double>(integer); }

Number Number::inexact(double value, Kind kind) {
  Number out;
  out.exact_ = false;
  out.kind_ = kind;
  out.value_ = value;
  return out;
}

Number Number::as_float(Kind kind) const {
  Number out = *this;
  out.kind_ = kind;
  return out;
}

std::optional<Number> Number::ratio(std::int64_t numerator, std::int64_t denominator) {
  if (denominator == 0) return std::nullopt;
  if (numerator == kMin || denominator == kMin) {
    return inexact(as_double(numerator) / as_double(denominator));
  }
  if (denominator < 0) {
    numerator = -numerator;
    denominator = -denominator;
  }
  const auto divisor = std::gcd(numerator, denominator);
  Number out;
  out.numerator_ = numerator / divisor;
  out.denominator_ = denominator / divisor;
  out.value_ = as_double(out.numerator_) / as_double(out.denominator_);
  return out;
}

Number::Parse Number::parse(std::string_view token, Number& out) {
  if (const auto slash = token.find('/'); slash != std::string_view::npos) {
    return parse_ratio(token, slash, out);
  }
  Decimal decimal;
  if (!split_decimal(token, decimal)) return Parse::kNotANumber;
  const auto kind = decimal.is_double ? Kind::kDouble : Kind::kSingle;
  if (const auto exact = exact_decimal(decimal)) {
    // `1.` is an integer in Lisp, as `1` is.
    const bool is_float = decimal.fraction_digits > 0 || decimal.has_exponent;
    out = is_float ? exact->as_float(kind) : *exact;
    return Parse::kNumber;
  }
  const auto text = fmt::format("{}{}e{}", decimal.negative ? "-" : "", decimal.digits,
                                decimal.exponent - decimal.fraction_digits);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  // Underflow and overflow share one error code; a tiny number is no reason to refuse a plan.
  if (error == std::errc::result_out_of_range) {
    const bool has_digit = decimal.digits.find_first_not_of('0') != std::string::npos;
    const auto magnitude = decimal.exponent - decimal.fraction_digits +
                           static_cast<std::int64_t>(decimal.digits.size());
    if (has_digit && magnitude > 0) return Parse::kOutOfRange;
    value = 0.0;
  }
  out = inexact(value, kind);
  return Parse::kNumber;
}

std::string Number::to_string() const {
  const std::string marker = kind_ == Kind::kDouble ? "d" : "e";
  const auto scientific = [&] {  // more digits than an exact one may have
    auto text = fmt::format("{:.20e}", value_);
    return text.replace(text.find('e'), 1, marker);
  };
  if (!exact_) return scientific();
  if (is_float()) {
    std::int64_t digits = numerator_;
    for (int places = 0; places <= kMaxExponent; ++places) {
      if (digits % denominator_ == 0) {
        const std::string suffix = kind_ == Kind::kDouble ? "d0" : "";
        return decimal_text(digits / denominator_, places) + suffix;
      }
      if (__builtin_mul_overflow(digits, std::int64_t{10}, &digits)) break;
    }
    return scientific();
  }
  if (denominator_ == 1) return fmt::format("{}", numerator_);
  return fmt::format("{}/{}", numerator_, denominator_);
}

namespace {

/// With a float among the operands the result is one, with a double a double.
Number of_kind(const Number& result, const Number& a, const Number& b) {
  const auto kind = std::max(a.kind(), b.kind());
  return kind == Number::Kind::kRational ? result : result.as_float(kind);
}

/// The same where the exact result does not fit.
Number inexact_of_kind(double result, const Number& a, const Number& b) {
  return Number::inexact(result, std::max({a.kind(), b.kind(), Number::Kind::kSingle}));
}

}  // namespace

Number operator+(const Number& a, const Number& b) {
  std::int64_t left = 0;
  std::int64_t right = 0;
  std::int64_t sum = 0;
  std::int64_t denominator = 0;
  if (a.exact() && b.exact() && !__builtin_mul_overflow(a.numerator(), b.denominator(), &left) &&
      !__builtin_mul_overflow(b.numerator(), a.denominator(), &right) &&
      !__builtin_add_overflow(left, right, &sum) &&
      !__builtin_mul_overflow(a.denominator(), b.denominator(), &denominator)) {
    return of_kind(*Number::ratio(sum, denominator), a, b);
  }
  return inexact_of_kind(a.value() + b.value(), a, b);
}

Number operator-(const Number& a, const Number& b) { return a + b * Number(-1); }

Number operator*(const Number& a, const Number& b) {
  std::int64_t numerator = 0;
  std::int64_t denominator = 0;
  if (a.exact() && b.exact() && !__builtin_mul_overflow(a.numerator(), b.numerator(), &numerator) &&
      !__builtin_mul_overflow(a.denominator(), b.denominator(), &denominator)) {
    return of_kind(*Number::ratio(numerator, denominator), a, b);
  }
  return inexact_of_kind(a.value() * b.value(), a, b);
}

std::optional<Number> divide(const Number& a, const Number& b) {
  if (b.exact() ? b.numerator() == 0 : b.value() == 0.0) return std::nullopt;
  if (b.exact() && b.numerator() != kMin) {
    return of_kind(a * *Number::ratio(b.denominator(), b.numerator()), a, b);
  }
  return inexact_of_kind(a.value() / b.value(), a, b);
}

int compare(const Number& a, const Number& b) {
  std::int64_t left = 0;
  std::int64_t right = 0;
  if (a.exact() && b.exact() && !__builtin_mul_overflow(a.numerator(), b.denominator(), &left) &&
      !__builtin_mul_overflow(b.numerator(), a.denominator(), &right)) {
    return left < right ? -1 : left > right ? 1 : 0;
  }
  return a.value() < b.value() ? -1 : a.value() > b.value() ? 1 : 0;
}

}  // namespace parallax::compiler
