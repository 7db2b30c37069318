#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/artifact/literal.h"

namespace parallax::compiler {

/// Adds `weight` where the literal is true; without a literal always.
struct ObjectiveTerm {
  std::int64_t weight = 0;  // not 0
  std::optional<Literal> literal;
  Timepoint needed = 0;  // counts in traces of this length and longer ones
  friend bool operator==(const ObjectiveTerm&, const ObjectiveTerm&) = default;
};

/// Sums of fewer never overflow, whichever of their terms are added.
inline constexpr std::int64_t kMostObjectiveWeight = std::int64_t{1} << 62;

/// A sum that is to be small. The weights' magnitudes add up to less than kMostObjectiveWeight.
struct Objective {
  std::string text;  // as it was given, on one line
  std::vector<ObjectiveTerm> terms;
  friend bool operator==(const Objective&, const Objective&) = default;
};

}  // namespace parallax::compiler
