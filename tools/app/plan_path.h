#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "compiler/plan/plan_graph.h"

namespace parallax::tools {

/// The way that an execution took through a plan's graph.
struct PlanPath {
  struct Step {
    compiler::LocationId location;
    bool succeeded = false;
    std::optional<std::size_t> way = {};  // how it failed, where that is known
  };
  std::vector<Step> steps;
  std::vector<compiler::PlanDecision> decisions;  // those that are certain
};

}  // namespace parallax::tools
