#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "harness/campaign/cover_watch.h"
#include "harness/confidence/criterion.h"
#include "harness/confidence/item_bounds.h"

namespace parallax::harness {

/// What a run has shown so far of the items that it goes on for, and how rare the others are.
class LoopCover {
 public:
  /// `watch` outlives the object; of the criterion confidence and epsilon count.
  LoopCover(CoverWatch& watch, const CriterionSpec& criterion);

  /// An execution that came to a result. `admitted`: the model has one like it.
  void note(const SampleRecord& record, bool admitted);
  /// Of these, one whose start was drawn: bounds are about them.
  void add_drawn();
  /// One whose start was drawn, and which came to no result.
  void add_lost();

  /// Was everything shown, or is rare what was not?
  bool is_over() const;
  /// All executions with a drawn start after which it is over, whatever they show, if no further
  /// one is lost; 0 without items.
  std::int64_t runs_needed() const;
  /// `at_limit`: the run may make no further execution.
  CoverResult result(bool at_limit) const;

 private:
  bool is_all_shown() const;

  CoverWatch& watch_;
  double epsilon_;
  std::vector<bool> shown_;           // by item
  std::optional<ItemBounds> bounds_;  // none: there is nothing to be shown
};

}  // namespace parallax::harness
