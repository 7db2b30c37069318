#pragma once

#include <vector>

#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {

class Circuit;

/// Counts true literals up to a bound (sequential counter, Sinz 2005).
class EventCounter {
 public:
  /// Adds |literals| * bound variables and about twice as many clauses.
  EventCounter(Circuit& circuit, SatSolver& solver, const std::vector<Literal>& literals,
               std::size_t bound);
  /// Implied by "at least `count` of them are true", 1 <= count <= bound.
  Literal at_least(std::size_t count) const { return reached_[count - 1]; }

 private:
  std::vector<Literal> reached_;
};

}  // namespace parallax::runtime
