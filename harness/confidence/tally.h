#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "compiler/base/contract.h"
#include "harness/region/region.h"

namespace parallax::harness {

/// The parameters of the regression of the paper's rule: continuous ones only.
struct RegressionFrame {
  std::vector<std::string> x_names;             // (n) initial parameters, sorted
  std::vector<Interval> x_range;                // (n) where they were drawn from [m, rad]
  std::vector<std::string> y_names;             // (m) final parameters, sorted
  std::vector<std::optional<Interval>> y_cell;  // (m) where the expected final state has them
  std::vector<std::string> not_covered;         // compared fluents that no parameter stands for
};

/// Everything a criterion may look at: counts, and one row per clean run. Results are fed one at a
/// time in order of the sample index, never in order of completion: failing runs take longer, and
/// completion order would stop before they come back.
class Tally {
 public:
  explicit Tally(RegressionFrame frame) : frame_(std::move(frame)) {
    PARALLAX_REQUIRE(frame_.x_names.size() == frame_.x_range.size(),
                     "a range per initial parameter");
    PARALLAX_REQUIRE(frame_.y_names.size() == frame_.y_cell.size(), "a cell per final parameter");
  }

  /// A uniform run whose final state was the expected one. `initial` (n) and `final_values` (m)
  /// follow the frame; a value that was not observed is NaN.
  void add_clean(std::span<const double> initial, std::span<const double> final_values) {
    PARALLAX_REQUIRE(initial.size() == frame_.x_names.size(), "a value per initial parameter");
    PARALLAX_REQUIRE(final_values.size() == frame_.y_names.size(), "a value per final parameter");
    x_.emplace_back(initial.begin(), initial.end());
    y_.emplace_back(final_values.begin(), final_values.end());
    ++clean_;
  }
  /// A run that ended in another state which the model admits, too. It is clean and has no row: the
  /// regression is about one expected final state.
  void add_clean_elsewhere() { ++clean_, ++elsewhere_; }
  /// A clean run of a trace with several initial states, of which the regression is not.
  void add_clean_of_many() { ++clean_; }
  /// A run that the simulator lost (crash, hang, invalid numbers): counts as a failure.
  void add_lost() { ++lost_; }
  /// Start states that were not valid and drawn again; no run at all.
  void add_rejected(std::int64_t count = 1) { rejected_ += count; }
  /// A run whose final state was not the expected one.
  void add_mismatch() { ++mismatch_; }

  std::int64_t clean() const { return clean_; }
  std::int64_t elsewhere() const { return elsewhere_; }  // of the clean ones
  std::int64_t lost() const { return lost_; }
  std::int64_t rejected() const { return rejected_; }
  std::int64_t mismatch() const { return mismatch_; }
  /// Runs that count for the certified bound.
  std::int64_t runs() const { return clean_ + lost_ + mismatch_; }

  const RegressionFrame& frame() const { return frame_; }
  /// (rows x n) and (rows x m), one row per clean run that ended as expected, in order.
  const std::vector<std::vector<double>>& x() const { return x_; }
  const std::vector<std::vector<double>>& y() const { return y_; }

 private:
  RegressionFrame frame_;
  std::vector<std::vector<double>> x_, y_;
  std::int64_t clean_ = 0, elsewhere_ = 0, lost_ = 0, rejected_ = 0, mismatch_ = 0;
};

}  // namespace parallax::harness
