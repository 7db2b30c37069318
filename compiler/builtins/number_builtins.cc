#include <fmt/core.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <variant>

#include "compiler/builtins/builtin_call.h"

namespace parallax::compiler {
namespace {

template <typename Combine>
BuiltinResult fold(const BuiltinCall& c, Number start, Combine combine) {
  for (std::size_t i = 0; i < c.args.size(); ++i) {
    const auto* number = c.number(i);
    if (number == nullptr) return not_a_number(c, i);
    start = combine(start, *number);
  }
  return c.values.number(start);
}

BuiltinResult add(const BuiltinCall& c) {
  return fold(c, Number(0), [](const Number& a, const Number& b) { return a + b; });
}

BuiltinResult multiply(const BuiltinCall& c) {
  return fold(c, Number(1), [](const Number& a, const Number& b) { return a * b; });
}

BuiltinResult subtract(const BuiltinCall& c) {
  if (c.number(0) == nullptr) return not_a_number(c, 0);
  if (c.args.size() == 1) return c.values.number(Number(0) - *c.number(0));
  const BuiltinCall rest{c.args.subspan(1), c.classes, c.values, c.links};
  return fold(rest, *c.number(0), [](const Number& a, const Number& b) { return a - b; });
}

BuiltinResult divide_all(const BuiltinCall& c) {
  if (c.number(0) == nullptr) return not_a_number(c, 0);
  Number result = c.args.size() == 1 ? Number(1) : *c.number(0);
  for (std::size_t i = c.args.size() == 1 ? 0 : 1; i < c.args.size(); ++i) {
    const auto* number = c.number(i);
    if (number == nullptr) return not_a_number(c, i);
    const auto quotient = divide(result, *number);
    if (!quotient) return BuiltinFailure{BuiltinError::kValue, "division by zero"};
    result = *quotient;
  }
  return c.values.number(result);
}

BuiltinResult extreme(const BuiltinCall& c, int sign) {
  if (c.number(0) == nullptr) return not_a_number(c, 0);
  return fold(c, *c.number(0),
              [sign](const Number& a, const Number& b) { return compare(b, a) == sign ? b : a; });
}
BuiltinResult minimum(const BuiltinCall& c) { return extreme(c, -1); }
BuiltinResult maximum(const BuiltinCall& c) { return extreme(c, 1); }

BuiltinResult absolute(const BuiltinCall& c) {
  if (c.number(0) == nullptr) return not_a_number(c, 0);
  const Number number = *c.number(0);
  return c.values.number(number.value() < 0 ? Number(0) - number : number);
}

template <int kStep>
BuiltinResult step(const BuiltinCall& c) {
  if (c.number(0) == nullptr) return not_a_number(c, 0);
  return c.values.number(*c.number(0) + Number(kStep));
}

template <typename Accept>
BuiltinResult chain(const BuiltinCall& c, Accept accept) {
  bool holds = true;
  for (std::size_t i = 0; i < c.args.size(); ++i) {
    if (c.number(i) == nullptr) return not_a_number(c, i);
    if (i > 0 && !accept(compare(*c.number(i - 1), *c.number(i)))) holds = false;
  }
  return c.values.boolean(holds);
}

BuiltinResult equal_numbers(const BuiltinCall& c) {
  return chain(c, [](int s) { return s == 0; });
}
BuiltinResult less(const BuiltinCall& c) {
  return chain(c, [](int s) { return s < 0; });
}
BuiltinResult greater(const BuiltinCall& c) {
  return chain(c, [](int s) { return s > 0; });
}
BuiltinResult at_most(const BuiltinCall& c) {
  return chain(c, [](int s) { return s <= 0; });
}
BuiltinResult at_least(const BuiltinCall& c) {
  return chain(c, [](int s) { return s >= 0; });
}

BuiltinResult different_numbers(const BuiltinCall& c) {
  bool holds = true;
  for (std::size_t i = 0; i < c.args.size(); ++i) {
    if (c.number(i) == nullptr) return not_a_number(c, i);
    for (std::size_t j = 0; j < i; ++j) holds = holds && compare(*c.number(j), *c.number(i)) != 0;
  }
  return c.values.boolean(holds);
}

/// (%larger so-far number): nil so far does not count.
template <int kSign>
BuiltinResult better(const BuiltinCall& c) {
  if (c.number(1) == nullptr) return not_a_number(c, 1);
  if (c.values.is_nil(c.args[0])) return c.args[1];
  if (c.number(0) == nullptr) return not_a_number(c, 0);
  return compare(*c.number(1), *c.number(0)) == kSign ? c.args[1] : c.args[0];
}

/// The integer beside a quotient, in the way of `floor` and its like.
enum class Rounding : std::uint8_t { kFloor, kCeiling, kTruncate, kRound };

std::optional<std::int64_t> rounded(const Number& quotient, Rounding way) {
  constexpr double kLargest = 9.0e18;
  if (!quotient.exact()) {
    const double value = quotient.value();
    if (!(std::abs(value) < kLargest)) return std::nullopt;
    switch (way) {
      case Rounding::kFloor:
        return static_cast<std::int64_t>(std::floor(value));
      case Rounding::kCeiling:
        return static_cast<std::int64_t>(std::ceil(value));
      case Rounding::kTruncate:
        return static_cast<std::int64_t>(std::trunc(value));
      case Rounding::kRound:
        return static_cast<std::int64_t>(std::nearbyint(value));
    }
  }
  const auto above = quotient.numerator();
  const auto below = quotient.denominator();
  const auto cut = above / below;
  const auto rest = above % below;
  const auto floor = rest < 0 ? cut - 1 : cut;
  if (rest == 0 || way == Rounding::kTruncate) return cut;
  if (way == Rounding::kFloor) return floor;
  if (way == Rounding::kCeiling) return floor + 1;
  // Halves go to the even neighbour.
  const auto twice =
      compare(*divide(Number(rest < 0 ? rest + below : rest), Number(below)), *Number::ratio(1, 2));
  return twice < 0 || (twice == 0 && floor % 2 == 0) ? floor : floor + 1;
}

struct Division {
  Number quotient;
  Number rest;
};

std::variant<Division, BuiltinFailure> divided(const BuiltinCall& c, Rounding way) {
  for (std::size_t i = 0; i < c.args.size(); ++i) {
    if (c.number(i) == nullptr) return not_a_number(c, i);
  }
  const Number divisor = c.args.size() > 1 ? *c.number(1) : Number(1);
  const auto quotient = divide(*c.number(0), divisor);
  if (!quotient) return BuiltinFailure{BuiltinError::kValue, "division by zero"};
  const auto whole = rounded(*quotient, way);
  if (!whole) return BuiltinFailure{BuiltinError::kValue, "the quotient is too large"};
  return Division{Number(*whole), *c.number(0) - Number(*whole) * divisor};
}

/// The quotient and, as a second value, the rest.
template <Rounding kWay>
BuiltinResult divide_whole(const BuiltinCall& c) {
  const auto result = divided(c, kWay);
  if (const auto* failure = std::get_if<BuiltinFailure>(&result)) return *failure;
  const auto& division = std::get<Division>(result);
  return c.values.multiple({c.values.number(division.quotient), c.values.number(division.rest)});
}

template <Rounding kWay>
BuiltinResult rest(const BuiltinCall& c) {
  const auto result = divided(c, kWay);
  if (const auto* failure = std::get_if<BuiltinFailure>(&result)) return *failure;
  return c.values.number(std::get<Division>(result).rest);
}

/// How the number compares with zero.
template <int kSign>
BuiltinResult has_sign(const BuiltinCall& c) {
  if (c.number(0) == nullptr) return not_a_number(c, 0);
  return c.values.boolean(compare(*c.number(0), Number(0)) == kSign);
}

template <int kRest>
BuiltinResult has_parity(const BuiltinCall& c) {
  const auto* number = c.number(0);
  if (number == nullptr) return not_a_number(c, 0);
  if (!number->is_integer()) return c.wrong(0, "an integer");
  return c.values.boolean((number->numerator() % 2 != 0 ? 1 : 0) == kRest);
}

/// Whole floats are exact, like those that are written.
Number as_float(double value, bool wide) {
  constexpr double kExact = 9.0e15;
  const auto kind = wide ? Number::Kind::kDouble : Number::Kind::kSingle;
  if (std::abs(value) < kExact && std::floor(value) == value) {
    return Number(static_cast<std::int64_t>(value)).as_float(kind);
  }
  return Number::inexact(value, kind);
}

/// A function of real numbers, which gives a float.
template <double (*kFunction)(double)>
BuiltinResult real(const BuiltinCall& c) {
  if (c.number(0) == nullptr) return not_a_number(c, 0);
  const auto& number = *c.number(0);
  const double value = kFunction(number.value());
  if (!std::isfinite(value)) return c.wrong(0, "a number for which it is real and finite");
  const bool wide = number.kind() == Number::Kind::kDouble;
  return c.values.number(as_float(value, wide));
}

double root(double x) { return std::sqrt(x); }
double sine(double x) { return std::sin(x); }
double cosine(double x) { return std::cos(x); }
double tangent(double x) { return std::tan(x); }
double arc_sine(double x) { return std::asin(x); }
double arc_cosine(double x) { return std::acos(x); }
double exponential(double x) { return std::exp(x); }
double arc_tangent_of_one(double x) { return std::atan(x); }

/// (atan y [x])
BuiltinResult arc_tangent(const BuiltinCall& c) {
  if (c.args.size() == 1) return real<arc_tangent_of_one>(c);
  for (std::size_t i = 0; i < 2; ++i) {
    if (c.number(i) == nullptr) return not_a_number(c, i);
  }
  const bool wide =
      c.number(0)->kind() == Number::Kind::kDouble || c.number(1)->kind() == Number::Kind::kDouble;
  return c.values.number(as_float(std::atan2(c.number(0)->value(), c.number(1)->value()), wide));
}

BuiltinResult signum(const BuiltinCall& c) {
  if (c.number(0) == nullptr) return not_a_number(c, 0);
  const Number sign(compare(*c.number(0), Number(0)));
  return c.values.number(c.number(0)->is_float() ? sign.as_float(c.number(0)->kind()) : sign);
}

/// (expt base power) with an integer as power.
BuiltinResult power(const BuiltinCall& c) {
  constexpr std::int64_t kMost = 1'000;
  for (std::size_t i = 0; i < 2; ++i) {
    if (c.number(i) == nullptr) return not_a_number(c, i);
  }
  const auto& exponent = *c.number(1);
  if (!exponent.is_integer() || std::abs(exponent.numerator()) > kMost) {
    return c.wrong(1, "an integer from -1000 to 1000");
  }
  Number out(1);
  if (c.number(0)->is_float()) out = out.as_float(c.number(0)->kind());
  for (std::int64_t i = 0; i < std::abs(exponent.numerator()); ++i) out = out * *c.number(0);
  if (exponent.numerator() >= 0) return c.values.number(out);
  const auto inverse = divide(Number(1), out);
  if (!inverse) return BuiltinFailure{BuiltinError::kValue, "division by zero"};
  return c.values.number(*inverse);
}

constexpr BuiltinEntry kNumberTable[] = {
    {{"sqrt", 1, 1}, real<root>},
    {{"sin", 1, 1}, real<sine>},
    {{"cos", 1, 1}, real<cosine>},
    {{"tan", 1, 1}, real<tangent>},
    {{"asin", 1, 1}, real<arc_sine>},
    {{"acos", 1, 1}, real<arc_cosine>},
    {{"exp", 1, 1}, real<exponential>},
    {{"atan", 1, 2}, arc_tangent},
    {{"signum", 1, 1}, signum},
    {{"expt", 2, 2}, power},
    {{"floor", 1, 2}, divide_whole<Rounding::kFloor>},
    {{"ceiling", 1, 2}, divide_whole<Rounding::kCeiling>},
    {{"truncate", 1, 2}, divide_whole<Rounding::kTruncate>},
    {{"round", 1, 2}, divide_whole<Rounding::kRound>},
    {{"mod", 2, 2}, rest<Rounding::kFloor>},
    {{"rem", 2, 2}, rest<Rounding::kTruncate>},
    {{"%larger", 2, 2}, better<1>},
    {{"%smaller", 2, 2}, better<-1>},
    {{"zerop", 1, 1}, has_sign<0>},
    {{"plusp", 1, 1}, has_sign<1>},
    {{"minusp", 1, 1}, has_sign<-1>},
    {{"evenp", 1, 1}, has_parity<0>},
    {{"oddp", 1, 1}, has_parity<1>},
    {{"+", 0, kAnyNumber}, add},
    {{"*", 0, kAnyNumber}, multiply},
    {{"-", 1, kAnyNumber}, subtract},
    {{"/", 1, kAnyNumber}, divide_all},
    {{"min", 1, kAnyNumber}, minimum},
    {{"max", 1, kAnyNumber}, maximum},
    {{"abs", 1, 1}, absolute},
    {{"1+", 1, 1}, step<1>},
    {{"1-", 1, 1}, step<-1>},
    {{"=", 1, kAnyNumber}, equal_numbers},
    {{"/=", 1, kAnyNumber}, different_numbers},
    {{"<", 1, kAnyNumber}, less},
    {{">", 1, kAnyNumber}, greater},
    {{"<=", 1, kAnyNumber}, at_most},
    {{">=", 1, kAnyNumber}, at_least},
};

}  // namespace

std::span<const BuiltinEntry> number_builtins() { return kNumberTable; }

}  // namespace parallax::compiler
