#include "harness/simulator/arithmetic.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "compiler/base/sha256.h"

namespace parallax::harness {
namespace {

constexpr int kFixedArguments =
    2'000;  // two implementations of sin differ in about one of a hundred
constexpr std::size_t kArithmeticDigits = 16;

using MathFunction = double (*)(double);

// Through pointers that the compiler does not see through: what it computed itself would be the
// same everywhere.
volatile double unknown_one = 1.0;

constexpr std::array<MathFunction, 14> kMathFunctions = {
    [](double x) { return std::sin(x); },        [](double x) { return std::cos(x); },
    [](double x) { return std::tan(x); },        [](double x) { return std::atan(x); },
    [](double x) { return std::exp(-x / 64); },  [](double x) { return std::log(x); },
    [](double x) { return std::pow(x, 1.3); },   [](double x) { return std::atan2(x, 3.3); },
    [](double x) { return std::asin(1.0 / x); }, [](double x) { return std::acos(1.0 / x); },
    [](double x) { return std::sinh(x / 64); },  [](double x) { return std::cbrt(x); },
    [](double x) { return std::hypot(x, 0.7); }, [](double x) { return std::sqrt(x); },
};

void append_bits(std::uint64_t bits, std::string& text) {
  for (int i = 0; i < 8; ++i) text += static_cast<char>(bits >> (8 * i) & 0xff);
}

}  // namespace

std::string arithmetic_digits() {
  std::string results;
  double sum = 0.0;
  for (int i = 0; i < kFixedArguments; ++i) {
    const double x = unknown_one * (1.0 + 0.37 * i);
    for (const auto function : kMathFunctions) {
      const double y = function(x);
      append_bits(std::bit_cast<std::uint64_t>(y), results);
      sum += y * unknown_one;  // one rounding or two
    }
    const float small = static_cast<float>(x);
    append_bits(std::bit_cast<std::uint32_t>(std::sin(small) + std::exp(-small / 64)), results);
  }
  append_bits(std::bit_cast<std::uint64_t>(sum), results);
  return base::sha256_hex(results).substr(0, kArithmeticDigits);
}

}  // namespace parallax::harness
