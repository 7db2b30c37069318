// A part of the start region in which runs fail, as a rule of one or two borders.
//
// The tree with the least error is found exactly, failed and clean runs weighing the same in
// total: every border between two values that occur is tried, and behind each side the best
// single border, with counts carried along in sorted order. A permutation test first asks
// whether as good a tree, found greedily, comes of shuffled outcomes as well (level 0.001).
// Cross-validation in ten parts chooses between one and two borders and gives the accuracy that
// is told; a second border has to be worth its while. The rule is the leaf with most failures.
// Borders are the numbers with the fewest digits between two values.
//
// Cost for n runs and p parameters: n^2 p^2 for an exact tree of depth 2, ten more for
// validation, and 999 greedy trees of n p.

#include "harness/cause/failure_rule.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>
#include <random>

namespace parallax::harness {
namespace {

constexpr std::size_t kParts = 10;
constexpr std::int64_t kFewestRuns = 5;
constexpr int kShuffles = 999;
constexpr double kLeastAccuracy = 0.6;
/// A second border has to be worth this much of foretelling.
constexpr double kWorth = 0.02;

/// Weights of failed and clean runs: each kind has one half.
struct Weights {
  double failed = 0.0, clean = 0.0;
  explicit Weights(const std::vector<CauseRun>& runs) {
    std::int64_t failures = 0;
    for (const auto& run : runs) failures += run.failed ? 1 : 0;
    const auto others = static_cast<std::int64_t>(runs.size()) - failures;
    if (failures > 0) failed = 0.5 / static_cast<double>(failures);
    if (others > 0) clean = 0.5 / static_cast<double>(others);
  }
  double of(const CauseRun& run) const { return run.failed ? failed : clean; }
};

/// The weight of both kinds among some runs.
struct Mass {
  double failed = 0.0, clean = 0.0;
  void add(bool fails, const Weights& weights) {
    (fails ? failed : clean) += fails ? weights.failed : weights.clean;
  }
  Mass without(const Mass& part) const { return {failed - part.failed, clean - part.clean}; }
  bool fails() const { return failed > clean; }
  double error() const { return std::min(failed, clean); }
};

/// Differences below this are those of the order in which weights were added.
constexpr double kSame = 1e-9;

}  // namespace

double round_between(double lower, double upper) {
  for (int digits = 1; digits < 17; ++digits) {
    const auto middle = lower + (upper - lower) / 2;
    const double candidate = std::strtod(fmt::format("{:.{}g}", middle, digits).c_str(), nullptr);
    if (lower <= candidate && candidate < upper) return candidate;
  }
  return lower;
}

namespace {

class TreeSearch {
 public:
  explicit TreeSearch(const std::vector<CauseRun>& runs) : runs_(runs), weights_(runs) {
    const auto parameters = runs.empty() ? 0 : runs.front().start.size();
    for (std::size_t p = 0; p < parameters; ++p) {
      auto& order = orders_.emplace_back(runs.size());
      std::iota(order.begin(), order.end(), std::size_t{0});
      std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return runs[a].start[p] < runs[b].start[p];
      });
    }
  }

  /// The error of the best border with the best border behind each of its sides, where the runs
  /// failed that `failed` says (as many as did). Cheap, for many of those.
  double greedy_error(const std::vector<bool>& failed) {
    failed_ = &failed;
    const std::vector<bool> all(runs_.size(), true);
    const auto root = best_side(all, true);
    double error = root.error;
    if (root.border) {
      std::vector<bool> above(runs_.size());
      for (std::size_t i = 0; i < runs_.size(); ++i) above[i] = root.border->holds(runs_[i]);
      error = best_side(above, false).error + best_side(above, true).error;
    }
    failed_ = nullptr;
    return error;
  }

  CauseTree best(int depth) const {
    const std::vector<bool> all(runs_.size(), true);
    CauseTree out;
    if (depth <= 1) {
      const auto found = best_side(all, true);
      out.root = found.border;
      for (int side = 0; side < 2; ++side) {
        out.sides[side].fails[0] = out.sides[side].fails[1] = found.fails[side];
      }
      if (!out.root) out.sides[0] = found.side();
      return out;
    }
    const auto alone = best_side(all, true);
    double least = alone.error;
    int borders = alone.border ? 1 : 0;
    out = best(1);
    for (std::size_t p = 0; p < orders_.size(); ++p) {
      std::vector<bool> below(runs_.size(), false);
      for (std::size_t i = 0; i + 1 < runs_.size(); ++i) {
        below[orders_[p][i]] = true;
        const double here = value(p, i), next = value(p, i + 1);
        if (!(here < next)) continue;
        const auto lower = best_side(below, true), upper = best_side(below, false);
        const double error = lower.error + upper.error;
        const int count = 1 + (lower.border ? 1 : 0) + (upper.border ? 1 : 0);
        if (error > least - kSame && !(error < least + kSame && count < borders)) continue;
        least = error;
        borders = count;
        out.root = Border{p, round_between(here, next), true};
        out.sides[0] = lower.side();
        out.sides[1] = upper.side();
      }
    }
    return out;
  }

 private:
  struct Found {
    std::optional<Border> border;
    bool fails[2] = {false, false};
    double error = 0.0;
    CauseTree::Side side() const { return {border, {fails[0], fails[1]}}; }
  };

  double value(std::size_t parameter, std::size_t place) const {
    return runs_[orders_[parameter][place]].start[parameter];
  }

  /// The best border among the runs whose mark is `wanted`.
  Found best_side(const std::vector<bool>& marks, bool wanted) const {
    Mass whole;
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      if (marks[i] == wanted) whole.add(failed(i), weights_);
    }
    Found best;
    best.fails[0] = best.fails[1] = whole.fails();
    best.error = whole.error();
    for (std::size_t p = 0; p < orders_.size(); ++p) {
      Mass below;
      std::optional<double> last;
      for (const auto i : orders_[p]) {
        if (marks[i] != wanted) continue;
        const double here = runs_[i].start[p];
        if (last && *last < here) {
          const auto above = whole.without(below);
          const double error = below.error() + above.error();
          if (error < best.error - kSame) {
            best = {
                Border{p, round_between(*last, here), true}, {below.fails(), above.fails()}, error};
          }
        }
        below.add(failed(i), weights_);
        last = here;
      }
    }
    return best;
  }

  bool failed(std::size_t i) const { return failed_ == nullptr ? runs_[i].failed : (*failed_)[i]; }

  const std::vector<CauseRun>& runs_;
  const std::vector<bool>* failed_ = nullptr;  // replaces the outcomes of the runs
  Weights weights_;
  std::vector<std::vector<std::size_t>> orders_;  // by parameter: runs by its value
};

/// The predictions of trees for runs that they were not made from.
struct Foretold {
  std::int64_t failed_right = 0, failed_wrong = 0, clean_right = 0, clean_wrong = 0;

  double accuracy() const {
    const auto share = [](std::int64_t right, std::int64_t wrong) {
      return static_cast<double>(right) / static_cast<double>(right + wrong);
    };
    return (share(failed_right, failed_wrong) + share(clean_right, clean_wrong)) / 2;
  }
};

/// Ten parts with as many of each kind, as far as that goes.
Foretold cross_validated(const std::vector<CauseRun>& runs, int depth) {
  std::vector<std::size_t> part(runs.size());
  std::array<std::size_t, 2> next{};
  for (std::size_t i = 0; i < runs.size(); ++i) part[i] = next[runs[i].failed]++ % kParts;
  Foretold out;
  for (std::size_t left_out = 0; left_out < kParts; ++left_out) {
    std::vector<CauseRun> rest;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      if (part[i] != left_out) rest.push_back(runs[i]);
    }
    const auto tree = best_tree(rest, depth);
    for (std::size_t i = 0; i < runs.size(); ++i) {
      if (part[i] != left_out) continue;
      const bool foretold = tree.predicts_failure(runs[i]);
      if (runs[i].failed) {
        ++(foretold ? out.failed_right : out.failed_wrong);
      } else {
        ++(foretold ? out.clean_wrong : out.clean_right);
      }
    }
  }
  return out;
}

/// Permutation test: is a tree as good found where the same number of other runs have failed, in
/// one of 999 shuffles? Runs that fail whatever their start get by with a chance of 0.001.
bool may_be_luck(const std::vector<CauseRun>& runs) {
  TreeSearch search(runs);
  std::vector<bool> failed;
  for (const auto& run : runs) failed.push_back(run.failed);
  const double found = search.greedy_error(failed);
  std::mt19937_64 bits(1);
  for (int shuffle = 0; shuffle < kShuffles; ++shuffle) {
    for (std::size_t i = failed.size(); i > 1; --i) {
      const auto j = static_cast<std::size_t>(bits() % i);
      const bool kept = failed[i - 1];
      failed[i - 1] = failed[j];
      failed[j] = kept;
    }
    if (search.greedy_error(failed) < found + kSame) return true;
  }
  return false;
}

/// The leaf of the tree with most failures, among those that say so.
FailureRule rule_of(const CauseTree& tree, const std::vector<CauseRun>& runs) {
  FailureRule best;
  for (int side = 0; side < 2; ++side) {
    const auto& below = tree.sides[side];
    auto root = *tree.root;
    root.above = side == 1;
    for (int leaf = 0; leaf < (below.border ? 2 : 1); ++leaf) {
      if (!below.fails[leaf]) continue;
      FailureRule rule;
      rule.borders = {root};
      if (below.border) {
        rule.borders.push_back(*below.border);
        rule.borders.back().above = leaf == 1;
      }
      for (const auto& run : runs) {
        const bool inside = std::all_of(rule.borders.begin(), rule.borders.end(),
                                        [&](const Border& border) { return border.holds(run); });
        ++(run.failed ? rule.failures : rule.clean);
        if (inside) ++(run.failed ? rule.failures_inside : rule.clean_inside);
      }
      if (rule.failures_inside > best.failures_inside) best = rule;
    }
  }
  return best;
}

}  // namespace

bool CauseTree::predicts_failure(const CauseRun& run) const {
  const auto& side = sides[root && root->holds(run) ? 1 : 0];
  return side.fails[side.border && side.border->holds(run) ? 1 : 0];
}

CauseTree best_tree(const std::vector<CauseRun>& runs, int depth) {
  return TreeSearch(runs).best(depth);
}

double tree_error(const CauseTree& tree, const std::vector<CauseRun>& runs) {
  const Weights weights(runs);
  double error = 0.0;
  for (const auto& run : runs) {
    if (tree.predicts_failure(run) != run.failed) error += weights.of(run);
  }
  return error;
}

std::optional<FailureRule> failure_rule(const std::vector<CauseRun>& runs) {
  std::int64_t failures = 0;
  for (const auto& run : runs) failures += run.failed ? 1 : 0;
  if (failures < kFewestRuns || static_cast<std::int64_t>(runs.size()) - failures < kFewestRuns) {
    return std::nullopt;
  }
  if (may_be_luck(runs)) return std::nullopt;
  const auto one = cross_validated(runs, 1), two = cross_validated(runs, 2);
  const int depth = two.accuracy() > one.accuracy() + kWorth ? 2 : 1;
  const auto& foretold = depth == 2 ? two : one;
  if (foretold.accuracy() <= kLeastAccuracy) return std::nullopt;
  const auto tree = best_tree(runs, depth);
  if (!tree.root) return std::nullopt;
  auto rule = rule_of(tree, runs);
  if (rule.borders.empty()) return std::nullopt;
  rule.accuracy = foretold.accuracy();
  return rule;
}

}  // namespace parallax::harness
