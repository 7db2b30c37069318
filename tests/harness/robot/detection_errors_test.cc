#include "harness/robot/detection_errors.h"

#include <doctest/doctest.h>

#include <cmath>

namespace parallax::harness {
namespace {

DetectionSpec only_noise() {
  DetectionSpec spec;
  spec.bias_m = spec.bias_rad = 0.0;
  return spec;
}

TEST_CASE("errors have the root mean squares that were asked for, and no side of their own") {
  DetectionErrors errors(only_noise());
  constexpr int kDraws = 20000;
  double squares_m2 = 0.0, squares_rad2 = 0.0, turn_rad = 0.0, longest_m = 0.0, widest_rad = 0.0;
  Eigen::Vector2d sum_m = Eigen::Vector2d::Zero();
  for (int i = 0; i < kDraws; ++i) {
    const DetectionError error = errors.next();
    squares_m2 += error.shift_m.squaredNorm();
    squares_rad2 += error.turn_rad * error.turn_rad;
    sum_m += error.shift_m;
    turn_rad += error.turn_rad;
    longest_m = std::max(longest_m, error.shift_m.norm());
    widest_rad = std::max(widest_rad, std::abs(error.turn_rad));
  }
  // The cut at twice the root mean square takes a few percent of the spread away.
  CHECK(std::sqrt(squares_m2 / kDraws) == doctest::Approx(0.004).epsilon(0.06));
  CHECK(std::sqrt(squares_rad2 / kDraws) == doctest::Approx(0.028).epsilon(0.15));
  CHECK(longest_m <= 0.008 + 1e-12);
  CHECK(longest_m > 0.0078);
  CHECK(widest_rad <= 0.056 + 1e-12);
  CHECK(widest_rad > 0.054);
  CHECK((sum_m / kDraws).norm() < 0.0001);
  CHECK(std::abs(turn_rad / kDraws) < 0.001);
}

TEST_CASE("a run has one bias, and another run another one") {
  DetectionSpec spec;
  spec.noise_m = spec.noise_rad = 0.0;
  DetectionErrors errors(spec);
  double squares_m2 = 0.0;
  constexpr int kRuns = 2000;
  for (int seed = 0; seed < kRuns; ++seed) {
    errors.reset(static_cast<std::uint64_t>(seed));
    const DetectionError first = errors.next(), second = errors.next();
    CHECK(first.shift_m == second.shift_m);
    CHECK(first.turn_rad == second.turn_rad);
    squares_m2 += first.shift_m.squaredNorm();
  }
  CHECK(std::sqrt(squares_m2 / kRuns) == doctest::Approx(0.003).epsilon(0.08));
}

TEST_CASE("the same seed and the same questions give the same answers, bit for bit") {
  DetectionSpec spec;
  spec.miss_rate = spec.confusion_rate = 0.3;
  DetectionErrors one(spec), other(spec);
  one.reset(7), other.reset(8);
  CHECK(one.next().shift_m != other.next().shift_m);
  one.reset(7), other.reset(7);
  for (int i = 0; i < 100; ++i) {
    const DetectionError a = one.next(), b = other.next();
    CHECK(a.shift_m == b.shift_m);
    CHECK(a.turn_rad == b.turn_rad);
    CHECK(one.missed() == other.missed());
    CHECK(one.confused() == other.confused());
  }
}

TEST_CASE("misses and confusions come as often as their rates say; at 0 and 1 never and always") {
  DetectionSpec spec;
  DetectionErrors never(spec);
  spec.miss_rate = spec.confusion_rate = 1.0;
  DetectionErrors always(spec);
  spec.miss_rate = 0.2;
  DetectionErrors some(spec);
  int missed = 0;
  for (int i = 0; i < 5000; ++i) {
    CHECK_FALSE(never.missed());
    CHECK_FALSE(never.confused());
    CHECK(always.missed());
    CHECK(always.confused());
    if (some.missed()) ++missed;
  }
  CHECK(missed / 5000.0 == doctest::Approx(0.2).epsilon(0.1));
}

}  // namespace
}  // namespace parallax::harness
