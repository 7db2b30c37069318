#include "harness/search/strategy.h"

#include <array>

#include "compiler/base/contract.h"
#include "harness/search/strategies.h"

namespace parallax::harness {
namespace {

/// In the order of the enumerators.
constexpr std::array<std::string_view, 7> kStrategyNames = {
    "uniform", "sobol",    "boundary", "cross-entropy", "expected-improvement",
    "descent", "portfolio"};

}  // namespace

std::string_view to_string(StrategyKind kind) {
  return kStrategyNames[static_cast<std::size_t>(kind)];
}

std::span<const std::string_view> strategy_names() { return kStrategyNames; }

std::optional<StrategyKind> strategy_kind(std::string_view name) {
  for (std::size_t i = 0; i < kStrategyNames.size(); ++i) {
    if (kStrategyNames[i] == name) return static_cast<StrategyKind>(i);
  }
  return std::nullopt;
}

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
