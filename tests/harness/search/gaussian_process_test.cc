#include "harness/search/gaussian_process.h"

#include <doctest/doctest.h>

#include <cmath>

#include "harness/search/search_rng.h"

namespace parallax::harness {
namespace {

struct Data {
  std::vector<std::vector<double>> points;
  std::vector<double> values;
  GaussianProcess::Points pointers() const {
    GaussianProcess::Points out;
    for (const auto& point : points) out.push_back(&point);
    return out;
  }
};

template <typename Function>
Data sampled(std::size_t dimensions, int count, Function function) {
  SearchRng rng(3, 9);
  Data data;
  for (int i = 0; i < count; ++i) {
    std::vector<double> point(dimensions);
    for (auto& value : point) value = rng.uniform();
    data.values.push_back(function(point));
    data.points.push_back(std::move(point));
  }
  return data;
}

double wavy(const std::vector<double>& x) { return std::sin(6.0 * x[0]) + x[1] * x[1]; }

TEST_CASE("gaussian process: it goes through what was seen and is sure there, and not elsewhere") {
  const auto data = sampled(2, 40, wavy);
  GaussianProcess process(2, {});
  process.fit(data.pointers(), data.values);
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const auto at = process.predict(data.points[i]);
    CHECK(std::abs(at.mean - data.values[i]) < 0.05);
  }
  const auto inside = process.predict(data.points[0]).deviation;
  const auto outside = process.predict({3.0, -3.0}).deviation;
  CHECK(outside > 5.0 * inside);
}

TEST_CASE("gaussian process: errors between the points are as large as it says") {
  const auto data = sampled(2, 60, wavy);
  GaussianProcess process(2, {});
  process.fit(data.pointers(), data.values);
  const auto fresh = sampled(2, 300, wavy);
  int beyond = 0;
  double square = 0.0;
  for (std::size_t i = 60; i < fresh.points.size(); ++i) {
    const auto at = process.predict(fresh.points[i]);
    const double error = at.mean - fresh.values[i];
    square += error * error;
    if (std::abs(error) > 4.0 * at.deviation + 1e-3) ++beyond;
  }
  CHECK(std::sqrt(square / 240.0) < 0.1);
  CHECK(beyond < 12);
}

TEST_CASE("gaussian process: a few points in many dimensions tell an affine function") {
  const auto data = sampled(10, 24, [](const auto& x) { return 3.0 * x[0] - x[4] + 0.5 * x[9]; });
  GaussianProcess process(10, {});
  process.fit(data.pointers(), data.values);
  const auto low = process.predict({0, .5, .5, .5, 1, .5, .5, .5, .5, 0});
  CHECK(std::abs(low.mean + 1.0) < 0.2);
}

TEST_CASE("gaussian process: believing in a prediction changes no mean, but what is known") {
  const auto data = sampled(3, 20, [](const auto& x) { return x[0] * x[1] + x[2]; });
  GaussianProcess process(3, {});
  process.fit(data.pointers(), data.values);
  const std::vector<double> there = {0.9, 0.1, 0.5}, elsewhere = {0.2, 0.8, 0.3};
  const auto before = process.predict(there), other = process.predict(elsewhere);
  process.believe(there);
  CHECK(process.size() == 21);
  CHECK(process.predict(there).mean == doctest::Approx(before.mean).epsilon(1e-6));
  CHECK(process.predict(elsewhere).mean == doctest::Approx(other.mean).epsilon(1e-6));
  CHECK(process.predict(there).deviation < 0.5 * before.deviation);
}

TEST_CASE("gaussian process: the same point twice, with other values, is noise") {
  Data data = sampled(1, 6, [](const auto& x) { return x[0]; });
  data.points.push_back(data.points[0]);
  data.values.push_back(data.values[0] + 0.3);
  GaussianProcess process(1, {});
  process.fit(data.pointers(), data.values);
  CHECK(std::isfinite(process.predict(data.points[0]).mean));
}

}  // namespace
}  // namespace parallax::harness
