#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "harness/campaign/cover_watch.h"
#include "harness/confidence/criterion.h"
#include "harness/confidence/item_bounds.h"

namespace parallax::harness {

/// The covered items that a run has shown so far, and a bound on how rare the others are.
class LoopCover {
 public:
  /// `watch` outlives the object. Only confidence and epsilon of the criterion are used.
  LoopCover(CoverWatch& watch, const CriterionSpec& criterion);

  /// Notes an execution with a result. `admitted`: the model has one like it.
  void note(const SampleRecord& record, bool admitted);
  /// Counts a noted execution whose start was drawn; bounds are about these.
  void add_drawn();
  /// Counts an execution with a drawn start and without a result.
  void add_lost();

  /// Whether every item was shown, or those that were not are rare.
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
