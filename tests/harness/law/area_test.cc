#include "harness/region/area.h"

#include <doctest/doctest.h>

#include <numbers>

#include "harness/sampling/sampler.h"
#include "tests/harness/law/goodness.h"

namespace parallax::harness {
namespace {

constexpr int kGrid = 8;
constexpr std::uint64_t kAreaDraws = 40'000;

double shoelace(const std::vector<PlanePoint>& corners) {
  double sum = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto &a = corners[i], &b = corners[(i + 1) % corners.size()];
    sum += a[0] * b[1] - a[1] * b[0];
  }
  return std::abs(sum) / 2.0;
}

/// The part of a polygon on one side of a line parallel to an axis (Sutherland and Hodgman 1974).
std::vector<PlanePoint> cut(const std::vector<PlanePoint>& corners, std::size_t axis, double at,
                            bool above) {
  std::vector<PlanePoint> out;
  const auto in = [&](const PlanePoint& p) { return above ? p[axis] >= at : p[axis] <= at; };
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto &a = corners[i], &b = corners[(i + 1) % corners.size()];
    if (in(a)) out.push_back(a);
    if (in(a) == in(b)) continue;
    const double t = (at - a[axis]) / (b[axis] - a[axis]);
    PlanePoint p = {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
    p[axis] = at;
    out.push_back(p);
  }
  return out;
}

/// Counts uniform draws on a grid over the bounds and compares them with the cells' sizes.
void check_uniform(const Area& area,
                   const std::function<double(const PlanePoint&, const PlanePoint&)>& size_in,
                   std::uint64_t seed) {
  const auto [lower, upper] = area.bounds();
  std::vector<std::int64_t> counts(kGrid * kGrid);
  std::vector<double> shares(kGrid * kGrid);
  double whole = 0.0;
  const auto corner = [&](int i, int j) {
    return PlanePoint{lower[0] + (upper[0] - lower[0]) * i / kGrid,
                      lower[1] + (upper[1] - lower[1]) * j / kGrid};
  };
  for (int i = 0; i < kGrid; ++i) {
    for (int j = 0; j < kGrid; ++j) {
      shares[static_cast<std::size_t>(i * kGrid + j)] = size_in(corner(i, j), corner(i + 1, j + 1));
      whole += shares[static_cast<std::size_t>(i * kGrid + j)];
    }
  }
  for (double& share : shares) share /= whole;
  std::int64_t none = 0, outside = 0;
  for (std::uint64_t n = 0; n < kAreaDraws; ++n) {
    const CounterRng rng({.campaign_seed = seed, .sample = n});
    const auto point = area.at(rng.uniform(0), rng.uniform(1));
    if (!point) {
      ++none;
      continue;
    }
    // A rounded border may be missed by as much.
    outside += area.signed_distance_m(*point) < -1e-12 ? 1 : 0;
    const auto index = [&](std::size_t axis) {
      const double at = ((*point)[axis] - lower[axis]) / (upper[axis] - lower[axis]) * kGrid;
      return std::clamp(static_cast<int>(at), 0, kGrid - 1);
    };
    ++counts[static_cast<std::size_t>(index(0) * kGrid + index(1))];
  }
  CHECK(outside == 0);
  CHECK(test::chi_square_excess(counts, shares) < test::kChiSquareLimit);
  for (std::size_t i = 0; i < shares.size(); ++i) {
    if (shares[i] < 1e-12) CHECK(counts[i] == 0);
  }
  // The share that has no point is that of the overlaps, counted beyond once.
  const double expected = 1.0 - whole / area.total_size_m2();
  const double error = std::sqrt(std::max(expected, 1e-9) / static_cast<double>(kAreaDraws));
  CHECK(std::abs(static_cast<double>(none) / static_cast<double>(kAreaDraws) - expected) <
        6.0 * error + 2e-3);
}

/// Area inside a rectangle, by counting the points of a fine grid that `inside` accepts.
std::function<double(const PlanePoint&, const PlanePoint&)> counted(
    const std::function<bool(double, double)>& inside) {
  return [=](const PlanePoint& lower, const PlanePoint& upper) {
    constexpr int kSteps = 250;
    std::int64_t count = 0;
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; j < kSteps; ++j) {
        const double x = lower[0] + (upper[0] - lower[0]) * (i + 0.5) / kSteps;
        const double y = lower[1] + (upper[1] - lower[1]) * (j + 0.5) / kSteps;
        count += inside(x, y) ? 1 : 0;
      }
    }
    return static_cast<double>(count) / (kSteps * kSteps) * (upper[0] - lower[0]) *
           (upper[1] - lower[1]);
  };
}

/// A polygon round a middle whose corners lie at random distances: in general not convex.
PolygonShape star(std::uint64_t seed, int corners, bool clockwise) {
  const CounterRng rng({.campaign_seed = 77, .sample = seed});
  PolygonShape shape;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners * (clockwise ? -1.0 : 1.0);
    const double radius = 0.1 + rng.uniform(static_cast<std::uint64_t>(i));
    shape.corners.push_back({100.0 + radius * std::cos(angle), -3.0 + radius * std::sin(angle)});
  }
  return shape;
}

TEST_CASE("polygons of any sense and shape are drawn from uniformly, and have their size") {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    CAPTURE(seed);
    const auto shape = star(seed, 3 + static_cast<int>(seed) * 3, seed % 2 == 0);
    REQUIRE(fault_of(shape).empty());
    const Area area({shape});
    CHECK(area.total_size_m2() == doctest::Approx(shoelace(shape.corners)).epsilon(1e-9));
    const auto size = [&](const PlanePoint& lower, const PlanePoint& upper) {
      auto rest = cut(shape.corners, 0, lower[0], true);
      if (!rest.empty()) rest = cut(rest, 0, upper[0], false);
      if (!rest.empty()) rest = cut(rest, 1, lower[1], true);
      if (!rest.empty()) rest = cut(rest, 1, upper[1], false);
      return rest.size() < 3 ? 0.0 : shoelace(rest);
    };
    check_uniform(area, size, seed);
  }
}

TEST_CASE("a comb with corners on straight lines is cut into triangles all the same") {
  PolygonShape comb;
  for (int i = 0; i < 10; ++i) {
    comb.corners.push_back({i * 1.0, 0.0});
    comb.corners.push_back({i + 0.2, 5.0});
    comb.corners.push_back({i + 0.4, 0.0});
  }
  comb.corners.push_back({12.0, 0.0});
  comb.corners.push_back({12.0, -1.0});
  comb.corners.push_back({6.0, -1.0});
  comb.corners.push_back({0.0, -1.0});
  REQUIRE(fault_of(comb).empty());
  CHECK(Area({comb}).total_size_m2() == doctest::Approx(shoelace(comb.corners)).epsilon(1e-12));
}

TEST_CASE("discs, rings and overlapping unions are drawn from uniformly") {
  const RingShape disc{{1.0, 2.0}, 0.0, 0.5}, ring{{1.0, 2.0}, 0.3, 0.5};
  check_uniform(Area({disc}),
                counted([](double x, double y) { return std::hypot(x - 1.0, y - 2.0) <= 0.5; }),
                101);
  check_uniform(Area({ring}), counted([](double x, double y) {
                  const double r = std::hypot(x - 1.0, y - 2.0);
                  return r >= 0.3 && r <= 0.5;
                }),
                102);
  CHECK(Area({ring}).total_size_m2() == doctest::Approx(std::numbers::pi * (0.25 - 0.09)));
  // A square with a disc over its corner, a second square that lies within the first, and a ring
  // round nothing else.
  const PolygonShape square{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  const PolygonShape inner{{{0.2, 0.2}, {0.6, 0.2}, {0.6, 0.6}, {0.2, 0.6}}};
  const Area all({square, RingShape{{1, 1}, 0.0, 0.4}, inner, RingShape{{3, 0.5}, 0.2, 0.6}});
  check_uniform(all, counted([](double x, double y) {
                  const double far = std::hypot(x - 3.0, y - 0.5);
                  return (x >= 0 && x <= 1 && y >= 0 && y <= 1) ||
                         std::hypot(x - 1.0, y - 1.0) <= 0.4 || (far >= 0.2 && far <= 0.6);
                }),
                103);
}

TEST_CASE("the signed distance changes its sign where the area ends") {
  const Area area({star(5, 9, false), RingShape{{100.0, -1.0}, 0.2, 0.5}});
  const auto [lower, upper] = area.bounds();
  for (std::uint64_t n = 0; n < 4000; ++n) {
    const CounterRng rng({.campaign_seed = 9, .sample = n});
    const PlanePoint p = {lower[0] + rng.uniform(0) * (upper[0] - lower[0]),
                          lower[1] + rng.uniform(1) * (upper[1] - lower[1])};
    const double distance = area.signed_distance_m(p);
    CHECK(area.contains(p) == (distance >= 0.0));
    // No point within so far is on the other side.
    const double angle = 2.0 * std::numbers::pi * rng.uniform(2);
    const double reach = 0.999 * std::abs(distance);
    const PlanePoint q = {p[0] + reach * std::cos(angle), p[1] + reach * std::sin(angle)};
    CHECK(area.contains(q) == area.contains(p));
  }
}

TEST_CASE("what is no shape says why") {
  const auto fault = [](std::vector<PlanePoint> corners) {
    return fault_of(PolygonShape{std::move(corners)});
  };
  CHECK(fault({{0, 0}, {1, 0}}) == "has 2 corners");
  CHECK(fault({{0, 0}, {1, 1}, {1, 0}, {0, 1}}) ==
        "crosses or touches itself between (0, 0) and (1, 1)");
  CHECK(fault({{0, 0}, {1, 0}, {0, 0}, {1, 1}}) == "goes through (0, 0) twice");
  CHECK(fault({{0, 0}, {2, 0}, {1, 0}}) != "");
  CHECK(fault({{0, 0}, {2, 0}, {2, 1}, {1, 0}, {0, 1}}) != "");  // a corner on an edge
  CHECK(fault_of(RingShape{{0, 0}, 0.5, 0.5}) == "goes from 0.5 to 0.5 m");
  CHECK(fault_of(RingShape{{0, 0}, 0.0, 0.5}).empty());
}

}  // namespace
}  // namespace parallax::harness
