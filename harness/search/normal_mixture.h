#pragma once

#include <cstddef>
#include <vector>

#include "harness/search/search_history.h"
#include "harness/search/search_rng.h"

namespace parallax::harness {

struct WeightedPoint {
  UnitPoint point;
  double weight = 1.0;
};

/// A sum of normal laws, each with all its correlations.
class NormalMixture {
 public:
  /// Fits a mixture by expectation maximization, with as many parts, up to four, as Schwarz's
  /// criterion takes (1978). Each part is made somewhat wider than it is fitted, as tails that are
  /// too short cost more than wide ones. The points must not be empty.
  static NormalMixture fit(const std::vector<WeightedPoint>& points, SearchRng& rng);

  /// Makes `other` that share of the whole.
  void mix(const NormalMixture& other, double share);

  std::size_t size() const { return parts_.size(); }
  /// May lie outside of the cube.
  UnitPoint draw(SearchRng& rng) const;
  double density(const UnitPoint& point) const;

 private:
  struct Part {
    double share = 1.0;
    std::vector<double> mean;
    std::vector<double> root;  // lower triangle of the covariance's Cholesky root, row by row
    double log_scale = 0.0;    // of the density at the mean
  };
  /// The covariance's lower triangle; what keeps it from being singular is added.
  static void set_covariance(Part& part, std::vector<double> covariance, double floor);
  static double log_density(const Part& part, const UnitPoint& point);
  static std::vector<Part> begun(const std::vector<WeightedPoint>& points, std::size_t count,
                                 SearchRng& rng);
  static double improve(const std::vector<WeightedPoint>& points, std::vector<Part>& parts);
  void widen();

  std::vector<Part> parts_;
};

}  // namespace parallax::harness
