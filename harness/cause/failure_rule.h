#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace parallax::harness {

/// One simulation: the parameters of its start, and whether it failed.
struct CauseRun {
  std::vector<double> start;
  bool failed = false;
};

/// A side of a border.
struct Border {
  std::size_t parameter = 0;
  double value = 0.0;
  bool above = true;  // the side is `> value`, else `<= value`
  friend bool operator==(const Border&, const Border&) = default;

  bool holds(const CauseRun& run) const { return (run.start[parameter] > value) == above; }
};

/// A tree of at most two borders in each branch: a border, and behind either side perhaps another.
/// A leaf says whether the runs that get there fail.
struct CauseTree {
  struct Side {
    std::optional<Border> border;    // `above` is true
    bool fails[2] = {false, false};  // at or below it, above it; without a border both the same
  };
  std::optional<Border> root;  // `above` is true; none: one leaf, sides[0]
  Side sides[2];

  bool predicts_failure(const CauseRun& run) const;
};

/// The tree of depth 1 or 2 with the least error on the runs, where both kinds of runs, failed and
/// not, weigh the same in total. Of equally good ones the one with fewer borders, then with the
/// earlier parameter, then with the lower value. Borders lie where the fewest digits say them,
/// between two values that occur. Exact; cost: runs^2 * parameters^2 for depth 2.
CauseTree best_tree(const std::vector<CauseRun>& runs, int depth);

/// The weighted error of a tree, from 0 to 1; 0.5 is what a leaf alone comes to.
double tree_error(const CauseTree& tree, const std::vector<CauseRun>& runs);

/// A part of the start region in which runs fail.
struct FailureRule {
  std::vector<Border> borders;  // one or two
  std::int64_t failures_inside = 0, failures = 0;
  std::int64_t clean_inside = 0, clean = 0;
  /// The cross-validated accuracy of the tree (ten parts, each left out once): the mean of the
  /// shares of failed and of clean runs that it predicts correctly.
  double accuracy = 0.0;
  /// The borders are those of a failing start that was moved; no accuracy is known.
  bool by_moving = false;
};

/// The number with the fewest digits from `lower` (included) to `upper` (not).
double round_between(double lower, double upper);

/// None where the runs do not show one: fewer than five of a kind, a border that luck finds as well
/// (a permutation test with the level 0.001), or an accuracy of less than 0.6.
std::optional<FailureRule> failure_rule(const std::vector<CauseRun>& runs);

}  // namespace parallax::harness
