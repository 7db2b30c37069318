#pragma once

#include <atomic>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/certify/certificate.h"
#include "runtime/session/solver_session.h"
#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {

/// The clauses of a model, each of timepoint t > 0 bound to `reaches(t)`, and further clauses,
/// asked under assumptions. After an unsatisfiable call the object is the claim of that answer.
class ModelQuestion final : public ProofClaim {
 public:
  /// `model` and `stop` outlive the object; `claim` is what a contradiction says, on one line.
  ModelQuestion(const CompiledModel& model, std::string claim, const std::atomic<bool>* stop);

  const CompiledModel& model() const { return model_; }
  /// The clauses up to timepoint t, 1 .. horizon, hold.
  Literal reaches(Timepoint t) const { return lengths_.reaches(t); }
  Literal new_variable() { return Literal::positive(++variables_); }
  void add(std::span<const Literal> clause);
  void imply(Literal condition, Literal consequence);

  SolveStatus solve(std::vector<Literal> assumptions);
  bool value(Literal literal) const { return solver_->value(literal); }

  std::int64_t variables() const override { return variables_; }
  void for_each_clause(const Visit& visit) const override;
  std::string comment() const override;

 private:
  void visit_model(const Visit& visit) const;

  const CompiledModel& model_;
  LengthVariables lengths_;
  std::string claim_;
  std::unique_ptr<SatSolver> solver_;
  std::int32_t variables_;
  compiler::ClauseList more_;
  std::vector<Literal> assumed_;  // by the last call
};

}  // namespace parallax::runtime
