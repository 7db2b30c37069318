#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "harness/search/search_history.h"

namespace parallax::bench {

/// A function of a start whose least values are discrepancies, in a share `p` of the unit cube.
///
///     edge    falls towards a corner, in some coordinates faster than in others
///     band    distance from a plane that crosses the cube
///     corner  the largest of the distances from the faces of one corner
///     ridge   falls along a narrow curve in the first two coordinates, and towards the middle of
///             the others
///     decoy   distance from a pocket in the first four coordinates, beside a wide valley in which
///             nothing ever fails
///     flat    the pocket of decoy, of which nothing is told but that a start fails
class SearchWorld {
 public:
  /// The border is estimated from `sample_size` points of the cube, drawn from a fixed seed.
  SearchWorld(std::string_view name, std::size_t dimensions, std::vector<double> shares,
              std::size_t sample_size);

  const std::string& name() const { return name_; }
  std::size_t dimensions() const { return dimensions_; }
  const std::vector<double>& shares() const { return shares_; }
  /// Margins tell only whether a start fails.
  bool is_flat() const { return name_ == "flat"; }

  /// The result of a simulation from this point, where the share of discrepancies is
  /// `shares()[share]`.
  harness::Evaluation evaluate(const harness::UnitPoint& point, std::size_t share) const;

 private:
  double height(const harness::UnitPoint& point) const;

  std::string name_;
  std::size_t dimensions_;
  std::vector<double> shares_;
  std::vector<double> borders_;  // by share
};

/// "edge", "band", "corner", "ridge", "decoy", "flat"
const std::vector<std::string>& search_world_names();

}  // namespace parallax::bench
