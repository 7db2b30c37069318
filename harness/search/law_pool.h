#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "harness/search/normal_mixture.h"
#include "harness/search/start_population.h"

namespace parallax::harness {

/// The law of starts, mixed with one that was fitted: of each draw it has the probability `share`.
struct DefensiveLaw {
  double share = 1.0;
  std::optional<NormalMixture> fitted;
  std::int64_t draws = 0;  // those outside of the cube among them

  double density(const UnitPoint& point) const {
    return fitted ? share + (1.0 - share) * fitted->density(point) : 1.0;
  }
};

/// The draws from several laws, weighted as if all were from the laws' mean (Veach and Guibas 1995;
/// Cornuet, Marin, Mira and Robert 2012), and laws that are fitted to the best draws.
class LawPool {
 public:
  /// Keeps about `kept` points of the least margins.
  LawPool(std::size_t dimensions, std::size_t kept) : dimensions_(dimensions), kept_(kept) {}

  const std::vector<DefensiveLaw>& laws() const { return laws_; }
  /// A law all of whose draws were made, and those of them that have a margin.
  void add(DefensiveLaw law, const std::vector<Particle>& drawn);

  std::int64_t discrepancies() const { return discrepancies_; }
  /// The share of the cube where there are discrepancies, roughly.
  double probability() const;
  /// Fitted to all discrepancies, or, where they are few, to the points of the least margins; in
  /// part also to further ones behind these, so that it does not end where they end. None: all
  /// points are alike.
  std::optional<NormalMixture> fit(SearchRng& rng) const;

 private:
  struct Point {
    UnitPoint point;
    double margin = 0.0;
    double density = 0.0;  // of all draws together
  };
  std::vector<WeightedPoint> best(std::size_t count) const;

  std::size_t dimensions_, kept_;
  std::vector<DefensiveLaw> laws_;
  std::vector<Point> points_;  // by margin
  std::int64_t discrepancies_ = 0;
  double worst_ = 0.0;  // margin that there ever was
  bool any_ = false;
};

}  // namespace parallax::harness
