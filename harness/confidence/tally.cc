#include "harness/confidence/tally.h"

#include <utility>

#include "compiler/base/contract.h"

namespace parallax::harness {

Tally::Tally(RegressionFrame frame) : frame_(std::move(frame)) {
  PARALLAX_REQUIRE(frame_.x_names.size() == frame_.x_range.size(), "a range per initial parameter");
  PARALLAX_REQUIRE(frame_.y_names.size() == frame_.y_cell.size(), "a cell per final parameter");
}

void Tally::add_clean(std::span<const double> initial, std::span<const double> final_values) {
  PARALLAX_REQUIRE(initial.size() == frame_.x_names.size(), "a value per initial parameter");
  PARALLAX_REQUIRE(final_values.size() == frame_.y_names.size(), "a value per final parameter");
  x_.emplace_back(initial.begin(), initial.end());
  y_.emplace_back(final_values.begin(), final_values.end());
  ++clean_;
}

}  // namespace parallax::harness
