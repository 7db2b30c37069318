// Bayesian optimization: expected improvement of a Gaussian process (Jones, Schonlau and Welch
// 1998).
//
// The surrogate is fitted to the margins seen; invalid starts enter with the worst margin, so
// that the search keeps away from them. The next point is the candidate with the largest
// expected improvement over the best margin, times the probability that a start there is valid.
// Candidates are some points anywhere, some near the best point, some that differ from it in few
// coordinates, some at the cube's boundary, and then steps of shrinking width from the best
// candidate. For several points at a time the surrogate takes its own mean for the answer
// (Ginsbourger et al. 2010). Before the first few points, beyond 200, and where all margins are
// equal, points come from a Sobol sequence.
//
// Cost: one fit for each batch (gaussian_process.cc), some 280 predictions for each point.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "harness/search/strategies.h"

namespace parallax::harness {
namespace {

constexpr std::size_t kFewest = 8;  // points before a surrogate is trusted
// Numbers of candidates: anywhere, near the best point, far from it in a few coordinates only, and
// at the cube's boundary; then steps from the best of them.
constexpr std::size_t kAnywhere = 100, kNear = 60, kInFewCoordinates = 60, kAtBoundary = 20;
constexpr std::size_t kSteps = 40;

double improvement(const GaussianProcess::Prediction& at, double least) {
  if (at.deviation <= 0.0) return 0.0;
  const double z = (least - at.mean) / at.deviation;
  const double density = std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
  const double below = 0.5 * std::erfc(-z / std::numbers::sqrt2);
  return at.deviation * (z * below + density);
}

}  // namespace

ExpectedImprovementStrategy::ExpectedImprovementStrategy(std::size_t dimensions, std::uint64_t seed)
    : rng_(seed, 4), sequence_(dimensions, seed ^ 4U), surrogate_(dimensions, {}) {}

UnitPoint ExpectedImprovementStrategy::best_candidate(const SearchHistory& history) {
  const auto dimensions = history.dimensions();
  const auto& incumbent = history[*history.best()];
  UnitPoint best = incumbent.point;
  double most = -1.0;
  const auto consider = [&](UnitPoint point) {
    const double gain =
        improvement(surrogate_.predict(point), incumbent.margin) * history.validity(point);
    if (gain <= most) return;
    most = gain;
    best = std::move(point);
  };
  const auto jittered = [&](UnitPoint point, double deviation, double share) {
    const auto surely = static_cast<std::size_t>(rng_.uniform() * static_cast<double>(dimensions));
    for (std::size_t i = 0; i < dimensions; ++i) {
      if (i != surely && rng_.uniform() >= share) continue;
      point[i] = std::clamp(point[i] + deviation * rng_.normal(), 0.0, 1.0);
    }
    return point;
  };
  for (std::size_t i = 0; i < kAnywhere; ++i) consider(uniform_point(rng_, dimensions));
  for (std::size_t i = 0; i < kNear; ++i) {
    consider(jittered(incumbent.point, i % 2 == 0 ? 0.15 : 0.03, 1.0));
  }
  const double few = 2.0 / static_cast<double>(dimensions);
  for (std::size_t i = 0; i < kInFewCoordinates; ++i) consider(jittered(incumbent.point, 0.3, few));
  for (std::size_t i = 0; i < kAtBoundary; ++i) consider(boundary_point(rng_, dimensions));
  double width = 0.1;
  for (std::size_t i = 0; i < kSteps; ++i, width *= 0.93) consider(jittered(best, width, 0.5));
  return best;
}

std::vector<UnitPoint> ExpectedImprovementStrategy::propose(const SearchHistory& history,
                                                            std::size_t count) {
  const auto& judged = history.judged();
  std::vector<UnitPoint> points;
  if (history.is_flat() || judged.size() < kFewest || judged.size() > kMostPoints) {
    while (points.size() < count) points.push_back(sequence_.next());
    return points;
  }
  GaussianProcess::Points seen;
  std::vector<double> margins;
  double worst = history[*history.best()].margin;
  for (const auto number : judged) {
    seen.push_back(&history[number].point);
    margins.push_back(history[number].margin);
    worst = std::max(worst, margins.back());
  }
  // An invalid start enters with the worst margin seen, so that the search keeps away from it.
  for (const auto& evaluation : history.all()) {
    if (seen.size() > kMostPoints) break;
    if (evaluation.kind != EvaluationKind::kInvalid) continue;
    seen.push_back(&evaluation.point);
    margins.push_back(worst);
  }
  surrogate_.fit(seen, margins);
  while (points.size() < count) {
    points.push_back(best_candidate(history));
    if (points.size() < count) surrogate_.believe(points.back());
  }
  return points;
}

}  // namespace parallax::harness
