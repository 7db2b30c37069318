#include "harness/geometry_proof/flat_shapes.h"

#include <doctest/doctest.h>

#include <cmath>

#include "harness/sampling/sampler.h"

namespace parallax::harness {
namespace {

Polygon square(double x, double y, double half) {
  return {{x - half, y - half}, {x + half, y - half}, {x + half, y + half}, {x - half, y + half}};
}

TEST_CASE("a hull keeps the corners and nothing else") {
  Polygon points = square(0.0, 0.0, 1.0);
  points.push_back({0.2, 0.3});
  points.push_back({1.0, 0.0});
  const Polygon hull = hull_of(points);
  CHECK(hull.size() == 4);
  CHECK(area_of(hull) == doctest::Approx(4.0));
}

TEST_CASE("the common part of two squares") {
  const Polygon both = common_part(square(0.0, 0.0, 1.0), square(1.5, 1.5, 1.0));
  CHECK(area_of(both) == doctest::Approx(0.25));
  CHECK((centroid_of(both) - Eigen::Vector2d(0.75, 0.75)).norm() < 1e-12);
  CHECK(area_of(common_part(square(0.0, 0.0, 1.0), square(3.0, 0.0, 1.0))) <= 0.0);
}

TEST_CASE("the range of a cosine holds its peaks") {
  CHECK(cosine_range(-0.1, 0.2).upper == 1.0);
  CHECK(cosine_range(3.0, 3.3).lower == -1.0);
  CHECK(cosine_range(6.2, 6.4).upper == 1.0);
  const Bounds1 none = cosine_range(0.5, 1.0);
  CHECK(none.upper == doctest::Approx(std::cos(0.5)));
  CHECK(none.lower == doctest::Approx(std::cos(1.0)));
}

TEST_CASE("a support and a point inside hold wherever the frame is") {
  const CounterRng rng({5, 5, {}, 0, 0});
  const Polygon corners = square(0.3, -0.2, 0.25);
  const Eigen::Vector2d middle(0.3, -0.2), half(0.25, 0.25);
  for (std::uint64_t n = 0; n < 200; ++n) {
    const double x = rng.uniform(10 * n) - 0.5, y = rng.uniform(10 * n + 1) - 0.5;
    const double yaw = 6.0 * rng.uniform(10 * n + 2) - 3.0;
    const double wide = 0.05 * rng.uniform(10 * n + 3);
    const PlanarRange frame{{x, x + wide}, {y, y + wide}, {yaw, yaw + wide}};
    const double direction = 6.0 * rng.uniform(10 * n + 4);
    const double most = farthest(corners, frame, direction);
    const Eigen::Vector2d towards(std::cos(direction), std::sin(direction));
    const Eigen::Vector2d point =
        moved({middle}, {x, y}, yaw)[0] +
        0.3 * Eigen::Vector2d(rng.uniform(10 * n + 5) - 0.5, rng.uniform(10 * n + 6) - 0.5);
    const bool inside = surely_inside(point, frame, middle, 0.0, half, 0.0);
    for (std::uint64_t k = 0; k < 27; ++k) {
      const auto at = [&](std::uint64_t digit) { return 0.5 * wide * static_cast<double>(digit); };
      const Polygon there = moved(corners, {x + at(k % 3), y + at(k / 3 % 3)}, yaw + at(k / 9 % 3));
      for (const Eigen::Vector2d& corner : there) CHECK(towards.dot(corner) <= most + 1e-12);
      if (inside) {
        const Polygon speck = square(point.x(), point.y(), 1e-6);
        CHECK(area_of(common_part(speck, there)) > 0.9 * area_of(speck));
      }
    }
  }
}

}  // namespace
}  // namespace parallax::harness
