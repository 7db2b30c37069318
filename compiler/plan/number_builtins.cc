#include <fmt/core.h>

#include <cstdint>

#include "compiler/plan/builtin_call.h"

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

constexpr BuiltinEntry kNumberTable[] = {
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
