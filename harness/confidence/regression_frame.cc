#include "harness/confidence/regression_frame.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace parallax::harness {
namespace {

double number_in(const State& state, const std::string& name) {
  const auto found = state.find(name);
  if (found == state.end()) return std::numeric_limits<double>::quiet_NaN();
  if (const auto* real = std::get_if<double>(&found->second)) return *real;
  if (const auto* whole = std::get_if<std::int64_t>(&found->second)) {
    return static_cast<double>(*whole);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// Does some regressed variable belong to the body that the fluent is about?
bool is_covered(const GroundFluent& fluent, const InsideBinding& binding,
                const std::map<std::string, Interval>& cells) {
  const std::string prefix = with_arguments(binding.body, fluent) + ".";
  const auto first = cells.lower_bound(prefix);
  return first != cells.end() && first->first.starts_with(prefix);
}

}  // namespace

RegressionFrame regression_frame(const StateMapping& mapping, const StartCuboid& start,
                                 const std::vector<GroundFluent>& fluents,
                                 const std::set<std::string>& final_true) {
  RegressionFrame frame;
  for (const auto& dimension : start.dimensions) {
    frame.x_names.push_back(dimension.variable);
    frame.x_range.push_back(dimension.interval);
  }
  const auto cells = mapping.cells(fluents, final_true);
  for (const auto& [variable, cell] : cells) {
    frame.y_names.push_back(variable);
    frame.y_cell.emplace_back(cell);
  }
  for (const auto& fluent : fluents) {
    const FluentBinding* binding = mapping.find(fluent.symbol);
    PARALLAX_REQUIRE(binding != nullptr, "the mapping was checked against the model's fluents");
    if (binding->is_ignored()) continue;
    const auto* inside = binding->inside();
    if (inside != nullptr && is_covered(fluent, *inside, cells)) continue;
    frame.not_covered.push_back(fluent.text);
  }
  return frame;
}

std::vector<double> row_of(const State& state, std::span<const std::string> names,
                           std::span<const Interval> around) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  std::vector<double> row;
  for (std::size_t i = 0; i < names.size(); ++i) {
    double value = number_in(state, names[i]);
    if (is_angle(names[i]) && i < around.size()) {
      value -= kTurn * std::round((value - around[i].midpoint()) / kTurn);
    }
    row.push_back(value);
  }
  return row;
}

void add_clean_run(Tally& tally, const State& initial, const State& last) {
  const RegressionFrame& frame = tally.frame();
  std::vector<Interval> cells;
  for (const auto& cell : frame.y_cell) cells.push_back(cell.value_or(Interval{}));
  tally.add_clean(row_of(initial, frame.x_names, frame.x_range),
                  row_of(last, frame.y_names, cells));
}

}  // namespace parallax::harness
