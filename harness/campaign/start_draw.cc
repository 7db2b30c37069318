#include "harness/campaign/start_draw.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <numeric>

namespace parallax::harness {

std::int64_t state_at(double u, std::size_t states, std::span<const double> weights) {
  if (weights.empty()) {
    const auto drawn = static_cast<std::size_t>(u * static_cast<double>(states));
    return static_cast<std::int64_t>(std::min(drawn, states - 1)) + 1;
  }
  double left = u * std::accumulate(weights.begin(), weights.end(), 0.0);
  std::size_t drawn = 0;
  for (; drawn + 1 < weights.size(); ++drawn) {
    left -= weights[drawn];
    if (left < 0.0) break;
  }
  return static_cast<std::int64_t>(drawn) + 1;
}

FluentSet common_fluents(std::span<const FluentSet> states) {
  if (states.empty()) return {};
  FluentSet common = states.front();
  for (const auto& state : states.subspan(1)) {
    FluentSet both;
    std::set_intersection(common.begin(), common.end(), state.begin(), state.end(),
                          std::back_inserter(both));
    common = std::move(both);
  }
  return common;
}

std::string state_text(const FluentSet& state, const FluentSet& common,
                       const compiler::SymbolTable& symbols) {
  std::vector<std::string> told;
  for (const auto fluent : state) {
    if (!std::binary_search(common.begin(), common.end(), fluent)) {
      told.emplace_back(symbols.name(fluent));
    }
  }
  std::sort(told.begin(), told.end());
  return told.empty() ? std::string("none of the others' fluents")
                      : fmt::format("{}", fmt::join(told, " "));
}

}  // namespace parallax::harness
