#include "harness/confidence/item_bounds.h"

#include <algorithm>

#include "compiler/base/contract.h"
#include "harness/confidence/clean_runs.h"

namespace parallax::harness {

ItemBounds::ItemBounds(std::int64_t items, double confidence_level, double epsilon)
    : items_(items),
      confidence_level_(confidence_level),
      epsilon_(epsilon),
      item_level_(1.0 - (1.0 - confidence_level) /
                            static_cast<double>(std::max<std::int64_t>(items, 1))) {
  PARALLAX_REQUIRE(items >= 1, "something to be shown");
  PARALLAX_REQUIRE(epsilon > 0.0 && epsilon < 1.0, "a probability strictly between 0 and 1");
}

CertifiedBound ItemBounds::bound() const {
  if (lost_ == 0) return {confidence_level_, bound_after(runs_, item_level_)};
  // Either of two bounds may have ended the runs before.
  return {std::max(0.0, 1.0 - 2.0 * (1.0 - confidence_level_)),
          mixture_upper(lost_, runs_ + lost_, item_level_)};
}

std::int64_t ItemBounds::runs_needed() const {
  return lost_ == 0 ? harness::runs_needed(item_level_, epsilon_)
                    : mixture_runs_needed(lost_, item_level_, epsilon_);
}

bool ItemBounds::is_rare() const { return runs_ + lost_ >= runs_needed(); }

}  // namespace parallax::harness
