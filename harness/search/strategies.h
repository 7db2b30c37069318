#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "harness/search/gaussian_process.h"
#include "harness/search/search_rng.h"
#include "harness/search/sobol.h"
#include "harness/search/strategy.h"

namespace parallax::harness {

UnitPoint uniform_point(SearchRng& rng, std::size_t dimensions);
/// Each coordinate from Beta(0.3, 0.3), which is dense at 0 and 1.
UnitPoint boundary_point(SearchRng& rng, std::size_t dimensions);

class UniformStrategy final : public SearchStrategy {
 public:
  explicit UniformStrategy(std::uint64_t seed) : rng_(seed, 1) {}
  std::vector<UnitPoint> propose(const SearchHistory& history, std::size_t count) override;

 private:
  SearchRng rng_;
};

class SobolStrategy final : public SearchStrategy {
 public:
  SobolStrategy(std::size_t dimensions, std::uint64_t seed) : sequence_(dimensions, seed) {}
  std::vector<UnitPoint> propose(const SearchHistory& history, std::size_t count) override;

 private:
  SobolSequence sequence_;
};

/// Proposes every other point uniformly, the others by boundary_point.
class BoundaryStrategy final : public SearchStrategy {
 public:
  explicit BoundaryStrategy(std::uint64_t seed) : rng_(seed, 2) {}
  std::vector<UnitPoint> propose(const SearchHistory& history, std::size_t count) override;

 private:
  SearchRng rng_;
  bool at_boundary_ = false;
};

/// Cross-entropy (Rubinstein 1999) over the whole history: each coordinate normal, with mean and
/// deviation of the best tenth. Where that has shrunk to a point without a discrepancy, the points
/// around it no longer count, and it begins again elsewhere. Uniform at first, every tenth point
/// later, and where margins are constant.
class CrossEntropyStrategy final : public SearchStrategy {
 public:
  explicit CrossEntropyStrategy(std::uint64_t seed) : rng_(seed, 3) {}
  std::vector<UnitPoint> propose(const SearchHistory& history, std::size_t count) override;

 private:
  struct Place {
    UnitPoint centre;
    double radius = 0.0;
  };
  bool is_left(const UnitPoint& point) const;
  UnitPoint from_law(const std::vector<double>& mean, const std::vector<double>& deviation);

  SearchRng rng_;
  std::vector<Place> left_;
  std::size_t since_ = 0;  // evaluations before this one do not count towards shrinking
};

/// Expected improvement (Jones, Schonlau, Welch 1998) of a Gaussian process, times the probability
/// that the start is valid. Several points at a time by taking the mean for the answer (Ginsbourger
/// et al. 2010). Beyond 200 points, before the first few, and where margins are constant: Sobol.
class ExpectedImprovementStrategy final : public SearchStrategy {
 public:
  static constexpr std::size_t kMostPoints = 200;

  ExpectedImprovementStrategy(std::size_t dimensions, std::uint64_t seed);
  std::vector<UnitPoint> propose(const SearchHistory& history, std::size_t count) override;

 private:
  UnitPoint best_candidate(const SearchHistory& history);

  SearchRng rng_;
  SobolSequence sequence_;
  GaussianProcess surrogate_;
};

/// Goes from the best point to where an affine model of its neighbours predicts a discrepancy, as
/// far as it trusts it (after Hasofer and Lind 1974, Rackwitz and Fiessler 1978, with a trust
/// region). Where no step helps any more it leaves the place for the next best one.
class DescentStrategy final : public SearchStrategy {
 public:
  explicit DescentStrategy(std::uint64_t seed) : rng_(seed, 5) {}
  std::vector<UnitPoint> propose(const SearchHistory& history, std::size_t count) override;

 private:
  void learn(const SearchHistory& history);
  bool choose_centre(const SearchHistory& history);
  void fit_slope(const SearchHistory& history);
  UnitPoint downhill(const Evaluation& centre) const;
  UnitPoint step(const SearchHistory& history, std::size_t number);
  bool is_left(const SearchHistory& history, std::size_t number) const;

  SearchRng rng_;
  std::optional<std::size_t> centre_;
  double radius_ = 0.0;
  std::vector<double> slope_;
  std::vector<std::size_t> left_;
  std::size_t seen_ = 0;     // evaluations that were taken into account
  std::size_t in_vain_ = 0;  // steps since the centre moved
  std::vector<UnitPoint> proposed_;
};

/// Space is filled first; then the strategies take turns and learn from each other's points.
class PortfolioStrategy final : public SearchStrategy {
 public:
  PortfolioStrategy(std::size_t dimensions, std::uint64_t seed);
  std::vector<UnitPoint> propose(const SearchHistory& history, std::size_t count) override;

 private:
  UnitPoint explore(const SearchHistory& history);

  std::size_t first_;  // points before anything is learned
  SobolStrategy sobol_;
  SearchRng rng_;
  CrossEntropyStrategy cross_entropy_;
  ExpectedImprovementStrategy improvement_;
  DescentStrategy descent_;
  std::size_t turn_ = 0, explored_ = 0;
};

}  // namespace parallax::harness
