#include "harness/search/strategy.h"

#include "compiler/base/contract.h"
#include "harness/search/strategies.h"

namespace parallax::harness {
std::unique_ptr<SearchStrategy> make_strategy(StrategyKind kind, std::size_t dimensions,
                                              std::uint64_t seed) {
  PARALLAX_REQUIRE(dimensions > 0, "something to search in");
  switch (kind) {
    case StrategyKind::kUniform:
      return std::make_unique<UniformStrategy>(seed);
    case StrategyKind::kSobol:
      return std::make_unique<SobolStrategy>(dimensions, seed);
    case StrategyKind::kBoundary:
      return std::make_unique<BoundaryStrategy>(seed);
    case StrategyKind::kCrossEntropy:
      return std::make_unique<CrossEntropyStrategy>(seed);
    case StrategyKind::kExpectedImprovement:
      return std::make_unique<ExpectedImprovementStrategy>(dimensions, seed);
    case StrategyKind::kDescent:
      return std::make_unique<DescentStrategy>(seed);
    case StrategyKind::kPortfolio:
      break;
  }
  return std::make_unique<PortfolioStrategy>(dimensions, seed);
}

}  // namespace parallax::harness
