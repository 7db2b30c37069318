#pragma once

#include <cstdint>

#include "harness/confidence/criterion.h"

namespace parallax::harness {

/// Bounds how often a run shows an item, for the items that no run has shown yet. The number of
/// items is fixed before the first run, and the runs are independent. The bounds may be read after
/// every run, and any observation may end the runs.
///
/// Each item has the bound of `clean-runs` with the share (1-C) / items of the error. The
/// bound of an item that a run shows with probability p is false at some time only if the first
/// n(p) runs do not show it, n(p) being the first count whose bound is below p, which has
/// probability at most (1-C) / items. So all bounds hold together, at all times, with probability C
/// (Bonferroni), and no stopping rule can choose a moment at which they do not. A lost run may have
/// shown anything: it counts as having shown everything, and the bounds are those of the mixture.
class ItemBounds {
 public:
  /// `items` at least 1; `confidence_level` and `epsilon` in (0, 1).
  ItemBounds(std::int64_t items, double confidence_level, double epsilon);

  void add_run() { ++runs_; }
  void add_lost() { ++lost_; }

  std::int64_t items() const { return items_; }
  std::int64_t runs() const { return runs_; }  // without lost ones
  std::int64_t lost() const { return lost_; }
  /// The bound for each item that no run has shown; the confidence is that of all bounds together.
  CertifiedBound bound() const;
  /// Is it at most epsilon?
  bool is_rare() const;
  /// The total number of runs after which the bound is at most epsilon if no further run is lost.
  std::int64_t runs_needed() const;

 private:
  std::int64_t items_;
  double confidence_level_;
  double epsilon_;
  double item_level_;  // of each bound
  std::int64_t runs_ = 0, lost_ = 0;
};

/// Counts among runs of which no more than a number that was fixed before the first one is looked
/// at, so that what ends the runs has no influence on rates.
class FixedCount {
 public:
  explicit FixedCount(std::int64_t size) : size_(size) {}
  /// One more run. Is it among those that count?
  bool next() { return ++seen_ <= size_; }
  bool goes_on() const { return seen_ > size_; }  // were there more runs than count?
  std::int64_t planned() const { return size_; }
  std::int64_t counted() const { return seen_ < size_ ? seen_ : size_; }

 private:
  std::int64_t size_;
  std::int64_t seen_ = 0;
};

}  // namespace parallax::harness
