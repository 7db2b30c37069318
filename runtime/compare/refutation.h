#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "runtime/compare/circuit.h"
#include "runtime/compare/definitions.h"

namespace parallax::runtime {

/// A model's variables as literals of a circuit: observed and free ones as the caller says, the
/// others by their definitions.
class MappedModel {
 public:
  /// Both outlive the mapping. `given(v)` is asked for observed and free variables; without an
  /// answer the variable, and what depends on it, stays open.
  MappedModel(const compiler::CompiledModel& model, const Definitions& definitions,
              Circuit& circuit, const std::function<std::optional<Literal>(std::int32_t)>& given);

  /// None while the variable is open.
  std::optional<Literal> find(Literal literal) const;
  /// None if some of its variables are open.
  std::optional<Circuit::Clause> clause(std::size_t index) const;
  /// A copy in which the variables that are open have values: `free_value(v)` for free ones.
  MappedModel closed(const std::function<bool(std::int32_t)>& free_value) const;

 private:
  void define(std::int32_t variable);
  std::optional<Literal> gate(const Definition& definition) const;
  std::optional<Literal> forced(std::int32_t variable, const Definition& definition) const;

  const compiler::CompiledModel* model_;
  const Definitions* definitions_;
  Circuit* circuit_;
  std::vector<std::optional<Literal>> literals_;  // by variable - 1
};

/// Clauses by their literals, for look-up.
class ClauseSet {
 public:
  void insert(const Circuit::Clause& clause) {
    clauses_.emplace(clause.literals, Literal::positive(1));
  }
  bool contains(const Circuit::Clause& clause) const { return clauses_.contains(clause.literals); }

 private:
  LiteralLists clauses_;
};

/// The statement "the observables are no trace of this model" in the clauses of a solver: for given
/// values of the model's free variables, some clause is violated.
class Refutation {
 public:
  /// Violations at one timepoint; `some` is true only if one of its clauses is violated.
  struct Violations {
    compiler::Timepoint time = 0;
    Literal some;
  };

  /// `observed(v)`: the literal of an observed variable. Clauses of `asserted` hold anyway, so they
  /// cannot be violated. `impossible`: literals that no trace of the model has. The references
  /// outlive the object.
  Refutation(const compiler::CompiledModel& model, const Definitions& definitions, Circuit& circuit,
             SatSolver& solver, const ClauseSet& asserted,
             const std::function<Literal(std::int32_t)>& observed,
             const std::vector<Violations>& impossible);

  /// Requires that these values of the free variables make no trace of the model.
  void require(const std::function<bool(std::int32_t)>& free_value);
  /// Assumes for the next call that a clause up to `by` is violated.
  void assume_by(compiler::Timepoint by) const;

 private:
  bool is_relevant(std::size_t clause) const;
  void add(std::map<compiler::Timepoint, std::vector<Literal>>& found, std::size_t clause,
           const Circuit::Clause& mapped);
  std::vector<Violations> grouped(const std::map<compiler::Timepoint, std::vector<Literal>>& found);

  const compiler::CompiledModel& model_;
  const Definitions& definitions_;
  Circuit& circuit_;
  SatSolver& solver_;
  const ClauseSet& asserted_;
  MappedModel mapped_;
  std::vector<std::size_t> open_;   // clauses that depend on free variables
  std::vector<Violations> closed_;  // violations of the other clauses
  std::vector<Violations> all_;     // `closed_`, and those for all values required so far
};

}  // namespace parallax::runtime
