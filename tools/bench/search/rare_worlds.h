#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "harness/search/search_history.h"

namespace parallax::bench {

/// Functions of a start whose probability of a discrepancy is known exactly.
///
///     edge     the corner that a slanted plane cuts off the cube
///     band     a thin slab across the cube, along a slanted plane
///     corner   a small cube in a corner
///     ridge    along a narrow curve in the first two coordinates, towards its end
///     decoy    a ball in the first four coordinates, beside a wide valley that never fails
///     two      two such balls, apart
///     hidden   half of them as in edge, half in a ball of which margins tell nothing
class RareWorld {
 public:
  RareWorld(std::string name, std::size_t dimensions, double probability);
  const std::string& name() const { return name_; }
  std::size_t dimensions() const { return dimensions_; }
  double probability() const { return probability_; }
  harness::Evaluation evaluate(const harness::UnitPoint& point) const;

 private:
  /// The share of the cube where the slanted sum is below `border`.
  double share_below(double border) const;
  double border_with_share(double share) const;
  double slanted(const harness::UnitPoint& point) const;
  double height(const harness::UnitPoint& point) const;  // below 0: a discrepancy

  std::string name_;
  std::size_t dimensions_;
  double probability_;
  std::vector<double> slopes_;
  double size_ = 0.0, radius_ = 0.0;
};

const std::vector<std::string>& rare_world_names();

}  // namespace parallax::bench
