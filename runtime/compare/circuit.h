#pragma once

#include <cstdint>
#include <vector>

#include "runtime/compare/literal_lists.h"
#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {

/// Conjunctions as literals of a solver, the same conjunction always the same literal. Two models
/// that are mapped into one circuit thus share equal parts.
class Circuit {
 public:
  /// `first_free`: the first variable of the solver that the circuit may use. The solver outlives
  /// the circuit.
  Circuit(SatSolver& solver, std::int32_t first_free);

  Literal truth() const { return truth_; }
  Literal constant(bool value) const { return value ? truth_ : ~truth_; }
  Literal new_variable() { return Literal::positive(next_++); }
  /// A literal that is equivalent to the conjunction.
  Literal conjunction(std::vector<Literal> literals);
  Literal disjunction(std::vector<Literal> literals);

  /// A clause without false literals, sorted by variable; empty and `satisfied` if it is true
  /// whatever the values.
  struct Clause {
    std::vector<Literal> literals;
    bool satisfied = false;
  };
  Clause simplified(std::vector<Literal> literals) const;

 private:
  SatSolver* solver_;
  std::int32_t next_;
  Literal truth_;
  LiteralLists gates_;  // by the alternatives of each
};

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
