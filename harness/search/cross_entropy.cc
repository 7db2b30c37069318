// Search by cross-entropy (Rubinstein 1999) over the whole history.
//
// The best tenth of the points that count, at least six and at most six plus the dimensions,
// give each coordinate a normal law with their mean and a widened deviation; new points are
// drawn from it, those beyond a face of the cube put on the face. One point in ten is uniform,
// so that the search never stops looking elsewhere. Once the deviations have shrunk to almost
// nothing and some evaluations have passed since the last place was left, the place is left:
// points around it count no more, and the law widens over the rest. Coordinates are treated as
// independent.
//
// Cost: for each batch the best points times dimensions, and a look at each left place.

#include <algorithm>
#include <cmath>

#include "harness/search/strategies.h"

namespace parallax::harness {
namespace {

constexpr std::size_t kFirstPoints = 16;  // before a law is fitted
constexpr double kEliteShare = 0.1;
constexpr std::size_t kLeastElites = 6;
constexpr double kWidening = 1.2;      // of the deviation of the best, which always shrinks
constexpr double kUniformShare = 0.1;  // never stops looking everywhere
constexpr double kShrunkenTo = 1e-4;   // mean deviation of a coordinate: nothing more to find
constexpr std::size_t kPatience = 60;  // evaluations since the last place was left

}  // namespace

bool CrossEntropyStrategy::is_left(const UnitPoint& point) const {
  return std::any_of(left_.begin(), left_.end(), [&](const Place& place) {
    return squared_distance(place.centre, point) < place.radius * place.radius;
  });
}

UnitPoint CrossEntropyStrategy::from_law(const std::vector<double>& mean,
                                         const std::vector<double>& deviation) {
  UnitPoint point(mean.size());
  for (std::size_t i = 0; i < point.size(); ++i) {
    // Beyond a face it is put on the face: a law that ends there would seldom reach it.
    point[i] = std::clamp(mean[i] + deviation[i] * rng_.normal(), 0.0, 1.0);
  }
  return point;
}

std::vector<UnitPoint> CrossEntropyStrategy::propose(const SearchHistory& history,
                                                     std::size_t count) {
  const auto dimensions = history.dimensions();
  std::vector<std::size_t> elites;
  for (const auto number : history.leading()) {
    if (!is_left(history[number].point)) elites.push_back(number);
  }
  std::vector<UnitPoint> points;
  if (history.is_flat() || elites.size() < kFirstPoints) {
    while (points.size() < count) points.push_back(uniform_point(rng_, dimensions));
    return points;
  }
  const auto share = static_cast<std::size_t>(kEliteShare * static_cast<double>(elites.size()));
  // Never more than a few: what was tried long ago must not hold the law back.
  const auto wanted = std::min(std::max(kLeastElites, share), kLeastElites + dimensions);
  elites.resize(std::min(wanted, elites.size()));
  std::vector<double> mean(dimensions), deviation(dimensions);
  const auto n = static_cast<double>(elites.size());
  double spread = 0.0;
  for (std::size_t i = 0; i < dimensions; ++i) {
    for (const auto number : elites) mean[i] += history[number].point[i] / n;
    for (const auto number : elites) {
      const double off = history[number].point[i] - mean[i];
      deviation[i] += off * off / (n - 1.0);
    }
    deviation[i] = kWidening * std::sqrt(deviation[i]);
    spread += deviation[i] / static_cast<double>(dimensions);
  }
  if (spread < kShrunkenTo && history.all().size() >= since_ + kPatience) {
    left_.push_back(
        {history[elites.front()].point, 0.1 * std::sqrt(static_cast<double>(dimensions))});
    since_ = history.all().size();
    return propose(history, count);
  }
  while (points.size() < count) {
    points.push_back(rng_.uniform() < kUniformShare ? uniform_point(rng_, dimensions)
                                                    : from_law(mean, deviation));
  }
  return points;
}

}  // namespace parallax::harness
