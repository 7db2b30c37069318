// Moves of a population of starts that keep the uniform law (for splitting).
//
// A proposal must be as likely as its way back; then accepting it exactly when it is valid and
// below the level keeps the law of the starts below that level. Steps along the difference of
// two guides (ter Braak 2006) take over the shape of where the guides lie, in all or some
// coordinates; one coordinate drawn anew and normal steps of lengths over three decades,
// mirrored at the cube's faces, reach the rest. A step along a difference that leaves the cube
// is mirrored back where the signs of its coordinates are chance, as the way back is then as
// likely; else it is no move.
//
// Cost: dimensions for each proposal.

#include "harness/search/start_population.h"

#include <algorithm>
#include <cmath>

namespace parallax::harness {
namespace {

/// Back into the cube, as by mirrors at its faces.
double folded(double value) {
  const double turn = std::fmod(std::abs(value), 2.0);
  return turn > 1.0 ? 2.0 - turn : turn;
}

std::size_t index_below(SearchRng& rng, std::size_t count) {
  return std::min(count - 1, static_cast<std::size_t>(rng.uniform() * static_cast<double>(count)));
}

/// Along the difference of two others; false: they are in the same place.
bool step_along_difference(const std::vector<UnitPoint>& guides, SearchRng& rng, UnitPoint& point) {
  constexpr double kWhole = 0.4, kJump = 0.15, kSome = 0.4, kSigned = 0.5;
  const auto& from = guides[index_below(rng, guides.size())];
  const auto& to = guides[index_below(rng, guides.size())];
  const bool jump = rng.uniform() < kJump;  // from one place with discrepancies to another
  const bool whole = jump || rng.uniform() < kWhole;
  const double length = jump ? 1.0 : 1.68 * std::exp(-1.5 * rng.uniform());
  std::size_t changed = 0;
  UnitPoint step(point.size());
  for (std::size_t i = 0; i < point.size(); ++i) {
    if (!whole && rng.uniform() >= kSome) continue;
    step[i] = to[i] - from[i];
    if (step[i] != 0.0) ++changed;
  }
  if (changed == 0) return false;
  const double scale = jump ? 1.0 : length / std::sqrt(static_cast<double>(changed));
  const bool signs = !jump && rng.uniform() < kSigned;
  for (std::size_t i = 0; i < point.size(); ++i) {
    if (step[i] == 0.0) continue;
    const double sign = signs && rng.uniform() < 0.5 ? -scale : scale;
    point[i] += sign * step[i];
    // A mirror turns one coordinate round, so the way back is as likely only where signs are
    // chance.
    if (signs) point[i] = folded(point[i]);
  }
  return true;
}

}  // namespace

UnitPoint uniform_start(SearchRng& rng, std::size_t dimensions) {
  UnitPoint point(dimensions);
  for (auto& value : point) value = rng.uniform();
  return point;
}

std::optional<UnitPoint> moved(const UnitPoint& from, const std::vector<UnitPoint>& guides,
                               SearchRng& rng) {
  constexpr double kDifferences = 0.65, kOneAnew = 0.8;
  constexpr double kDecades = 3.0;  // of random lengths
  auto point = from;
  const double kind = rng.uniform();
  // Without a difference, a step of another kind is taken. Whether there is one is chance and does
  // not depend on the start.
  if (kind < kDifferences && guides.size() > 1 && step_along_difference(guides, rng, point)) {
    const bool inside =
        std::all_of(point.begin(), point.end(), [](double x) { return x >= 0.0 && x <= 1.0; });
    return inside ? std::optional(std::move(point)) : std::nullopt;
  }
  if (kind < kOneAnew) {
    point[index_below(rng, point.size())] = rng.uniform();
    return point;
  }
  const double length = 0.5 * std::pow(10.0, -kDecades * rng.uniform());
  for (auto& value : point) value = folded(value + length * rng.normal());
  return point;
}

}  // namespace parallax::harness
