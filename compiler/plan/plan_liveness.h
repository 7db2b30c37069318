#pragma once

#include <set>
#include <vector>

#include "compiler/plan/plan_graph.h"

namespace parallax::compiler {

using RegisterSet = std::set<ModelValueId>;

/// Which registers the rest of the plan still reads: by location and by branch. Terminals read
/// none.
struct PlanLiveness {
  std::vector<RegisterSet> locations;
  std::vector<RegisterSet> branches;
  /// Of a place that control goes to.
  const RegisterSet& at(const PlanTarget& target) const;
  /// On the way behind a location.
  const RegisterSet& behind(const PlanLocation& location, bool success) const {
    return at(success ? location.on_success : location.on_failure);
  }
};

/// The least fixed point, backwards. At most (places times registers) rounds over the graph, and
/// hardly ever more than three.
PlanLiveness plan_liveness(const PlanGraph& graph);

}  // namespace parallax::compiler
