// The strategies of the search take turns.
//
// At first space is filled evenly. Then expected improvement, descent, cross-entropy and
// exploration have one point in four each, and each learns from the points of all. Exploring
// points come from a Sobol sequence, one in three from near the cube's boundary. A strategy is
// asked once for all its points of a batch, so that it can spread them. Beyond the number of
// points that the surrogate can take, descent gets its turns; where margins are constant nothing
// can be learned and all points explore.

#include <algorithm>

#include "harness/search/strategies.h"

namespace parallax::harness {
namespace {

constexpr std::size_t kFirstLeast = 8;
constexpr std::size_t kBoundaryEvery = 3;      // of the points that explore
constexpr std::size_t kBoundaryEveryFlat = 8;  // likewise, where nothing can be learned

}  // namespace

PortfolioStrategy::PortfolioStrategy(std::size_t dimensions, std::uint64_t seed)
    : first_(std::max(kFirstLeast, dimensions)),
      sobol_(dimensions, seed),
      rng_(seed, 7),
      cross_entropy_(mix64(seed ^ 1U)),
      improvement_(dimensions, mix64(seed ^ 2U)),
      descent_(mix64(seed ^ 3U)) {}

UnitPoint PortfolioStrategy::explore(const SearchHistory& history) {
  const auto every = history.is_flat() ? kBoundaryEveryFlat : kBoundaryEvery;
  if (++explored_ % every == 0) return boundary_point(rng_, history.dimensions());
  return sobol_.propose(history, 1).front();
}

std::vector<UnitPoint> PortfolioStrategy::propose(const SearchHistory& history, std::size_t count) {
  std::vector<UnitPoint> points;
  const bool learns = !history.is_flat() && history.judged().size() >= first_;
  const bool surrogate = history.judged().size() <= ExpectedImprovementStrategy::kMostPoints;
  // The same strategy is asked once for all its points of a batch, so that it can spread them.
  std::size_t improvement = 0, descent = 0, cross_entropy = 0, exploration = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto turn = learns ? turn_++ % 4 : 3;
    if (turn == 0 && surrogate) ++improvement;
    if (turn == 1 || (turn == 0 && !surrogate)) ++descent;
    if (turn == 2) ++cross_entropy;
    if (turn == 3) ++exploration;
  }
  const auto take = [&](SearchStrategy& strategy, std::size_t wanted) {
    if (wanted == 0) return;
    for (auto& point : strategy.propose(history, wanted)) points.push_back(std::move(point));
  };
  take(improvement_, improvement);
  take(descent_, descent);
  take(cross_entropy_, cross_entropy);
  for (; exploration > 0; --exploration) points.push_back(explore(history));
  return points;
}

}  // namespace parallax::harness
