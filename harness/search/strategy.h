#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "compiler/base/word_table.h"
#include "harness/search/search_history.h"

namespace parallax::harness {

/// Proposes the points that a search tries next. Knows nothing of simulations: what it says follows
/// from its seed and from the history, which may hold points that others proposed.
///
/// The caller asks for batches of a fixed size, however many simulations run at a time, and adds
/// the answers to the history in the order of the points. So no result depends on that number.
class SearchStrategy {
 public:
  virtual ~SearchStrategy() = default;
  /// Proposes `count` points. The history has the answers to all earlier proposals.
  virtual std::vector<UnitPoint> propose(const SearchHistory& history, std::size_t count) = 0;
};

enum class StrategyKind : std::uint8_t {
  kUniform,
  kSobol,                // scrambled low-discrepancy points
  kBoundary,             // half of the points near faces and corners
  kCrossEntropy,         // a normal law fitted to the best points
  kExpectedImprovement,  // of a Gaussian process through at most 200 points
  kDescent,              // steps of local affine models to where these predict a discrepancy
  kPortfolio,            // all of them, which share what was tried
};
inline constexpr auto kSearchStrategies =
    base::word_table<StrategyKind>("uniform", "sobol", "boundary", "cross-entropy",
                                   "expected-improvement", "descent", "portfolio");
constexpr std::string_view to_string(StrategyKind kind) { return kSearchStrategies.of(kind); }

/// The most that a run can be asked for; with more, other methods answer.
inline constexpr std::int64_t kMaxSearchRuns = 10'000;

/// The search that a run makes before it certifies.
struct SearchSpec {
  std::int64_t runs = 0;  // simulations of each trace at most; 0: no search
  StrategyKind strategy = StrategyKind::kPortfolio;
  friend bool operator==(const SearchSpec&, const SearchSpec&) = default;
};

/// The number of points asked for at a time, whatever the number of jobs.
inline constexpr std::size_t kSearchBatch = 4;

std::unique_ptr<SearchStrategy> make_strategy(StrategyKind kind, std::size_t dimensions,
                                              std::uint64_t seed);

}  // namespace parallax::harness
