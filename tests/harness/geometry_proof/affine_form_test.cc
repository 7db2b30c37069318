#include "harness/geometry_proof/affine_form.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "harness/sampling/sampler.h"

namespace parallax::harness {
namespace {

constexpr std::size_t kVariables = 3;

CounterRng rng_of(std::uint64_t number) { return CounterRng({number, 7, {}, 0, 0}); }

/// An expression made at random, as a form and as a number at points: the same steps for both.
template <typename Number>
Number expression(const std::vector<Number>& inputs, std::uint64_t number) {
  using std::abs;
  using std::cos;
  using std::sin;
  using std::sqrt;
  const CounterRng rng = rng_of(number);
  std::vector<Number> values = inputs;
  for (std::uint64_t step = 0; step < 8; ++step) {
    const auto pick = [&](std::uint64_t salt) {
      return values[static_cast<std::size_t>(rng.uniform(10 * step + salt) *
                                             static_cast<double>(values.size()))];
    };
    const Number a = pick(0), b = pick(1);
    const auto which = static_cast<int>(rng.uniform(10 * step + 2) * 6.0);
    if constexpr (std::is_same_v<Number, double>) {
      values.push_back(which == 0   ? a + b
                       : which == 1 ? a - b
                       : which == 2 ? a * b
                       : which == 3 ? sin(a)
                       : which == 4 ? cos(a)
                                    : sqrt(abs(a) + 0.1));
    } else {
      values.push_back(which == 0   ? a + b
                       : which == 1 ? a - b
                       : which == 2 ? a * b
                       : which == 3 ? sine(a)
                       : which == 4 ? cosine(a)
                                    : root(absolute(a) + Number(0.1)));
    }
  }
  return values.back();
}

TEST_CASE("a form holds every value that the expression takes in its box") {
  for (std::uint64_t number = 0; number < 400; ++number) {
    const CounterRng rng = rng_of(number + 10'000);
    const double width = std::pow(10.0, -4.0 * rng.uniform(0));
    std::vector<AffineForm> forms;
    std::vector<Bounds1> box;
    for (std::size_t i = 0; i < kVariables; ++i) {
      const double low = 4.0 * rng.uniform(10 + i) - 2.0;
      box.push_back({low, low + width * rng.uniform(20 + i)});
      forms.push_back(AffineForm::variable(i, box[i].lower, box[i].upper));
    }
    const Bounds1 bounds = expression(forms, number).bounds();
    for (std::uint64_t sample = 0; sample < 60; ++sample) {
      std::vector<double> point;
      for (std::size_t i = 0; i < kVariables; ++i) {
        // Corners as often as the inside.
        const double u = rng.uniform(1000 + 10 * sample + i);
        const double share = sample % 2 == 0 ? u : std::round(u);
        point.push_back(share == 1.0 ? box[i].upper
                                     : box[i].lower + share * (box[i].upper - box[i].lower));
      }
      const double value = expression(point, number);
      CAPTURE(number);
      CHECK(value >= bounds.lower);
      CHECK(value <= bounds.upper);
    }
  }
}

TEST_CASE("what a form says too much shrinks with the square of the box") {
  double last = 0.0;
  for (const double half : {0.1, 0.01, 0.001}) {
    const AffineForm x = AffineForm::variable(0, 0.5 - half, 0.5 + half);
    const AffineForm y = AffineForm::variable(1, 0.3 - half, 0.3 + half);
    const double rest = (sine(x) * y + cosine(x * y) * x).rest();
    if (last > 0.0) CHECK(rest < last / 90.0);
    last = rest;
  }
}

TEST_CASE("a form remembers what depends on the same variable") {
  const AffineForm x = AffineForm::variable(0, -1.0, 2.0);
  CHECK(std::abs((x - x).upper()) < 1e-14);
  const AffineForm unrelated = AffineForm::within(0.5, 1.5);
  CHECK((unrelated - unrelated).upper() >= 3.0);
}

TEST_CASE("a root reaches down to 0, and an absolute value is never negative by much") {
  const AffineForm x = AffineForm::variable(0, -0.5, 1.0);
  CHECK(root(x).lower() <= 0.0);
  CHECK(root(x).upper() >= 1.0);
  CHECK(absolute(x).lower() <= 0.0);
  CHECK(absolute(x).upper() >= 1.0);
}

}  // namespace
}  // namespace parallax::harness
