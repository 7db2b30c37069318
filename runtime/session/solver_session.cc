#include "runtime/session/solver_session.h"

#include <algorithm>

namespace parallax::runtime {

SolverSession::SolverSession(const CompiledModel& model, std::unique_ptr<SatSolver> solver)
    : model_(&model),
      solver_(std::move(solver)),
      lengths_(model),
      variable_count_(lengths_.last()) {
  for (Timepoint t = 1; t <= model.horizon; ++t) guards_.push_back(lengths_.reaches(t));
  std::vector<Literal> guarded;
  for (std::size_t i = 0; i < model.clauses.size(); ++i) {
    const auto clause = model.clauses[i];
    const auto t = model.clause_timepoints[i];
    guarded.assign(clause.begin(), clause.end());
    // A definition of an auxiliary is harmless at any horizon.
    if (t > 0 && !model.clause_is_definition[i]) {
      guarded.push_back(~guards_[static_cast<std::size_t>(t) - 1]);
    }
    solver_->add_clause(guarded);
  }
  // The first solution that the search tries is the canonical one as often as possible.
  for (std::int32_t v = 1; v <= model.variable_count(); ++v) {
    solver_->set_phase(~Literal::positive(v));
  }
}

Literal SolverSession::new_variable() { return Literal::positive(++variable_count_); }

SolveStatus SolverSession::solve(Timepoint n, std::span<const Literal> assumptions) {
  for (std::size_t i = 0; i < guards_.size(); ++i) {
    solver_->assume(static_cast<Timepoint>(i) < n ? guards_[i] : ~guards_[i]);
  }
  for (const auto literal : assumptions) solver_->assume(literal);
  const auto status = solver_->solve();
  if (status == SolveStatus::kSatisfiable) {
    const auto count = model_->variable_count();
    values_.resize(static_cast<std::size_t>(count));
    for (std::int32_t v = 1; v <= count; ++v) {
      values_[static_cast<std::size_t>(v) - 1] = solver_->value(Literal::positive(v));
    }
  }
  return status;
}

void SolverSession::require_model(Timepoint n) const {
  for (std::size_t i = 0; i < model_->clauses.size(); ++i) {
    if (model_->clause_timepoints[i] > n) continue;
    const auto clause = model_->clauses[i];
    PARALLAX_REQUIRE(
        std::any_of(clause.begin(), clause.end(), [&](Literal literal) { return value(literal); }),
        "the solver's valuations satisfy every clause");
  }
}

bool SolverSession::value(Literal literal) const {
  PARALLAX_REQUIRE(static_cast<std::size_t>(literal.var()) <= values_.size(),
                   "a value of a model variable is asked after a satisfiable call");
  return values_[static_cast<std::size_t>(literal.var()) - 1] == literal.is_positive();
}

}  // namespace parallax::runtime
