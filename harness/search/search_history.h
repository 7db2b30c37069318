#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace parallax::harness {

/// A start as the search sees it: one number in [0, 1] for each dimension of the start cuboid.
using UnitPoint = std::vector<double>;

enum class EvaluationKind : std::uint8_t {
  kClean,
  kDiscrepancy,
  kLost,     // the simulator failed: nothing is known
  kInvalid,  // no start: bodies interpenetrate
};

/// A point that was tried and what came of it.
struct Evaluation {
  UnitPoint point;
  EvaluationKind kind = EvaluationKind::kClean;
  /// How far it was from a discrepancy: the smaller the nearer, negative for one. NaN: not known,
  /// as always for kLost and kInvalid.
  double margin = std::numeric_limits<double>::quiet_NaN();
};

/// All evaluations of one search, in the order of their numbers.
class SearchHistory {
 public:
  explicit SearchHistory(std::size_t dimensions) : dimensions_(dimensions) {}

  std::size_t dimensions() const { return dimensions_; }
  void add(Evaluation evaluation);

  const std::vector<Evaluation>& all() const { return all_; }
  /// Numbers of those that have a margin.
  const std::vector<std::size_t>& judged() const { return judged_; }
  const Evaluation& operator[](std::size_t number) const { return all_[number]; }
  /// The least margin, the first of several; none: there is no margin.
  std::optional<std::size_t> best() const { return best_; }
  /// Numbers of the least margins, in their order; at most kLeading.
  const std::vector<std::size_t>& leading() const { return leading_; }
  static constexpr std::size_t kLeading = 512;
  /// Are all margins the same? Then they give no direction.
  bool is_flat() const { return flat_; }
  /// Points that were no valid starts.
  std::size_t invalid() const { return invalid_; }
  /// The estimated validity of a point as a start, by its neighbours; 1 where none was invalid yet.
  double validity(const UnitPoint& point) const;

 private:
  std::size_t dimensions_;
  std::vector<Evaluation> all_;
  std::vector<std::size_t> judged_;
  std::optional<std::size_t> best_;
  std::vector<std::size_t> leading_;
  bool flat_ = true;
  std::size_t invalid_ = 0;
};

/// Squared Euclidean distance.
double squared_distance(const UnitPoint& a, const UnitPoint& b);

}  // namespace parallax::harness
