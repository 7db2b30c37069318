// A trial population for splitting.cc that shows where starts below each level lie.
//
// Starts are drawn uniformly; again and again the level falls to about the median of the
// margins, the better half stays, and the others become copies of these that make two moves
// each, guided by the half that stayed. The starts of each level are kept, as guides of the
// moves in the counted populations: guides must not depend on the population that they move, or
// its law would not be kept. The pilot itself is not counted, so its copies need not be
// independent of each other.
//
// Cost: at most the given number of simulations; it ends early when all are discrepancies or
// alike.

#include "harness/search/splitting_pilot.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace parallax::harness {
namespace {

constexpr std::int64_t kRunsPerPilot = 20;
constexpr std::int64_t kLeastPilot = 20, kMostPilot = 500;
constexpr int kMovesOfCopies = 2;

std::vector<UnitPoint> points_of(const std::vector<Particle>& particles) {
  std::vector<UnitPoint> points;
  for (const auto& one : particles) points.push_back(one.point);
  return points;
}

/// The level that about half are below; none: all are alike, or discrepancies.
std::optional<double> next_level(const std::vector<Particle>& particles) {
  std::vector<double> margins;
  for (const auto& one : particles) margins.push_back(one.margin);
  std::sort(margins.begin(), margins.end());
  if (margins.back() < 0.0) return std::nullopt;
  auto level = std::max(margins[margins.size() / 2], 0.0);
  // Some must stay, and some must not.
  if (margins.front() >= level) {
    const auto above = std::upper_bound(margins.begin(), margins.end(), level);
    if (above == margins.end()) return std::nullopt;
    level = *above;
  }
  return level;
}

}  // namespace

std::optional<std::vector<PilotLevel>> run_pilot(std::size_t dimensions, std::int64_t most,
                                                 SearchRng& rng, RareEventBatches& batches) {
  const auto size = std::clamp(most / kRunsPerPilot, kLeastPilot, kMostPilot);
  std::vector<Particle> particles;
  std::vector<Evaluation> answers;
  std::int64_t left = most;
  while (static_cast<std::int64_t>(particles.size()) < size && left > 0) {
    std::vector<UnitPoint> points;
    for (auto i = static_cast<std::int64_t>(particles.size()); i < size; ++i) {
      points.push_back(uniform_start(rng, dimensions));
    }
    if (!batches.run(points, answers)) return std::nullopt;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (answers[i].kind != EvaluationKind::kInvalid) --left;
      const double margin = answers[i].margin;
      if (std::isfinite(margin)) particles.push_back({std::move(points[i]), margin});
    }
  }
  std::vector<PilotLevel> levels;
  levels.push_back({std::numeric_limits<double>::infinity(), points_of(particles)});
  while (particles.size() > 1) {
    const auto level = next_level(particles);
    if (!level) break;
    const auto border =
        std::stable_partition(particles.begin(), particles.end(),
                              [&](const Particle& one) { return one.margin < *level; });
    const auto stay = static_cast<std::size_t>(border - particles.begin());
    std::vector<UnitPoint> guides = points_of({particles.begin(), border});
    for (std::size_t i = stay; i < particles.size(); ++i) particles[i] = particles[i % stay];
    for (int move = 0; move < kMovesOfCopies; ++move) {
      std::vector<UnitPoint> points;
      std::vector<std::size_t> which;
      for (std::size_t i = stay; i < particles.size(); ++i) {
        auto point = moved(particles[i].point, guides, rng);
        if (!point) continue;
        points.push_back(std::move(*point));
        which.push_back(i);
      }
      if (left < static_cast<std::int64_t>(points.size())) return levels;
      if (points.empty()) continue;
      if (!batches.run(points, answers)) return std::nullopt;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (answers[i].kind != EvaluationKind::kInvalid) --left;
        if (!(answers[i].margin < *level)) continue;
        particles[which[i]] = {std::move(points[i]), answers[i].margin};
      }
    }
    levels.push_back({*level, points_of(particles)});
  }
  return levels;
}

}  // namespace parallax::harness
