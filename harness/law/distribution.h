#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/region/region.h"

namespace parallax::harness {

/// The distribution of one value of a start, before anything conditions it.
struct Distribution {
  enum class Kind : std::uint8_t { kUniform, kNormal, kTriangular, kChoice };
  Kind kind = Kind::kUniform;
  double lower = 0.0, upper = 1.0;                // kUniform, kTriangular
  double mode = 0.5;                              // kTriangular
  double mean = 0.0, sd = 1.0;                    // kNormal
  std::vector<std::pair<double, double>> values;  // kChoice: value and weight, values ascending

  /// Where its values lie. A normal one ends 9 standard deviations from its mean: beyond it has
  /// 2e-19 of its mass, less than a draw of 53 bits can show.
  Interval support() const;
  /// "normal with mean 1 and sd 0.05"
  std::string text() const;
};

/// A distribution given that the value lies in an interval, drawn by the inverse of its
/// distribution function: one uniform number gives one value.
class ConditionedLaw {
 public:
  /// None where the distribution has no mass in `cell`. Of a continuous one the ends count by their
  /// closure; a normal one has mass as long as a double can hold it, 1e-300 (37 standard deviations
  /// off).
  static std::optional<ConditionedLaw> make(Distribution distribution, const Interval& cell);
  /// Increasing in `u`, from [0, 1).
  double at(double u) const;

 private:
  ConditionedLaw(Distribution distribution, const Interval& cell)
      : law_(std::move(distribution)), cell_(cell) {}
  Distribution law_;
  Interval cell_;
  /// Mass below either end of the cell; above it where the cell is in the upper half, whose tail
  /// would otherwise be lost in the rounding of numbers near 1.
  double from_ = 0.0, to_ = 1.0;
  bool mirrored_ = false;
};

}  // namespace parallax::harness
