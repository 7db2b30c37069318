#include "runtime/compare/event_counter.h"

#include "runtime/compare/circuit.h"

namespace parallax::runtime {

EventCounter::EventCounter(Circuit& circuit, SatSolver& solver,
                           const std::vector<Literal>& literals, std::size_t bound)
    : reached_(bound, circuit.constant(false)) {
  for (const auto literal : literals) {
    auto next = reached_;
    for (std::size_t j = 0; j < bound; ++j) {
      // Nothing before: as many as so far cannot be reached.
      const bool possible = j == 0 || reached_[j - 1] != circuit.constant(false);
      if (!possible) break;
      next[j] = circuit.new_variable();
      const Literal kept[] = {~reached_[j], next[j]};
      solver.add_clause(kept);
      std::vector<Literal> counted = {~literal, next[j]};
      if (j > 0) counted.push_back(~reached_[j - 1]);
      solver.add_clause(counted);
    }
    reached_ = std::move(next);
  }
}

}  // namespace parallax::runtime
