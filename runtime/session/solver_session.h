#pragma once

#include <memory>
#include <span>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "runtime/session/length_variables.h"
#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {

using compiler::CompiledModel;
using compiler::Timepoint;

/// One solver loaded with one compiled model, whose horizon is chosen per call. Every clause of
/// timepoint t carries the guard of t; a call with horizon n assumes the guards 1 .. n and drops
/// the others, so learned clauses survive from one horizon to the next.
class SolverSession {
 public:
  SolverSession(const CompiledModel& model, std::unique_ptr<SatSolver> solver);

  const CompiledModel& model() const { return *model_; }
  const LengthVariables& lengths() const { return lengths_; }
  /// A variable of the session's own, for guards.
  Literal new_variable();
  void add_clause(std::span<const Literal> clause) { solver_->add_clause(clause); }
  /// Is there a valuation with horizon `n` under these assumptions? `values()` has it afterwards.
  SolveStatus solve(Timepoint n, std::span<const Literal> assumptions);
  /// Value of a literal in the valuation that the last satisfiable call found; it stays available
  /// until the next satisfiable call.
  bool value(Literal literal) const;
  /// Evaluates every clause of horizon `n` on the valuation at hand, without the solver: a solver
  /// that answers wrongly is a broken contract. Linear in the clauses.
  void require_model(Timepoint n) const;
  bool is_fixed(Literal literal) const { return solver_->is_fixed(literal); }
  std::int64_t solve_calls() const { return solver_->solve_calls(); }

 private:
  const CompiledModel* model_;  // outlives the session
  std::unique_ptr<SatSolver> solver_;
  LengthVariables lengths_;
  std::int32_t variable_count_ = 0;
  std::vector<Literal> guards_;  // by timepoint - 1
  std::vector<bool> values_;     // by variable - 1
};

}  // namespace parallax::runtime
