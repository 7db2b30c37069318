#include <cmath>

#include "harness/search/strategies.h"

namespace parallax::harness {
namespace {

constexpr double kBetaShape = 0.3;

/// Jöhnk 1964.
double symmetric_beta(SearchRng& rng, double shape) {
  for (;;) {
    const double a = std::pow(rng.uniform(), 1.0 / shape);
    const double b = std::pow(rng.uniform(), 1.0 / shape);
    if (a + b <= 1.0 && a + b > 0.0) return a / (a + b);
  }
}

}  // namespace

UnitPoint uniform_point(SearchRng& rng, std::size_t dimensions) {
  UnitPoint point(dimensions);
  for (auto& value : point) value = rng.uniform();
  return point;
}

UnitPoint boundary_point(SearchRng& rng, std::size_t dimensions) {
  UnitPoint point(dimensions);
  for (auto& value : point) value = symmetric_beta(rng, kBetaShape);
  return point;
}

std::vector<UnitPoint> UniformStrategy::propose(const SearchHistory& history, std::size_t count) {
  std::vector<UnitPoint> points;
  while (points.size() < count) points.push_back(uniform_point(rng_, history.dimensions()));
  return points;
}

std::vector<UnitPoint> SobolStrategy::propose(const SearchHistory& history, std::size_t count) {
  (void)history;
  std::vector<UnitPoint> points;
  while (points.size() < count) points.push_back(sequence_.next());
  return points;
}

std::vector<UnitPoint> BoundaryStrategy::propose(const SearchHistory& history, std::size_t count) {
  std::vector<UnitPoint> points;
  for (; points.size() < count; at_boundary_ = !at_boundary_) {
    points.push_back(at_boundary_ ? boundary_point(rng_, history.dimensions())
                                  : uniform_point(rng_, history.dimensions()));
  }
  return points;
}

}  // namespace parallax::harness
