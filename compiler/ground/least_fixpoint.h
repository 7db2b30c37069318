#pragma once

#include <cstdint>
#include <unordered_map>
#include <variant>
#include <vector>

#include "compiler/formula/formula.h"

namespace parallax::compiler {

/// Unknown truth values, each with the formula that it is equal to. In the
/// formulas atoms stand for the unknowns, any number of atoms for one.
struct FixpointSystem {
  std::unordered_map<std::int32_t, std::size_t> unknown_of;  // by variable; look-up only
  std::vector<FormulaId> definitions;                        // by unknown
};

/// An unknown that needs the next one on the path, the last one the first
/// again.
struct FixpointCycle {
  struct Step {
    std::size_t unknown = 0;
    bool negated = false;  // needs that the next one is false
  };
  std::vector<Step> path;  // the first step is negated
};

struct FixpointTooLarge {};

/// The least solution of the system, by unknown, without the unknowns in it:
/// what depends on nothing else first, then unknowns that depend on one
/// another, which start as false and are unfolded as often as there are of
/// them. A cycle through a negation has no least solution. The work on the
/// formulas is bounded by `max_nodes` new ones.
using FixpointResult = std::variant<std::vector<FormulaId>, FixpointCycle, FixpointTooLarge>;
FixpointResult least_fixpoint(FormulaStore& formulas, const FixpointSystem& system,
                              std::size_t max_nodes);

}  // namespace parallax::compiler
