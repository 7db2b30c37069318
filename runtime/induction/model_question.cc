#include "runtime/induction/model_question.h"

#include <fmt/format.h>

#include <utility>

namespace parallax::runtime {

ModelQuestion::ModelQuestion(const CompiledModel& model, std::string claim,
                             const std::atomic<bool>* stop)
    : model_(model),
      lengths_(model),
      claim_(std::move(claim)),
      solver_(make_cadical_solver(stop)),
      variables_(lengths_.last()) {
  visit_model([&](std::span<const Literal> clause) { solver_->add_clause(clause); });
}

void ModelQuestion::visit_model(const Visit& visit) const {
  std::vector<Literal> bound;
  for (std::size_t i = 0; i < model_.clauses.size(); ++i) {
    bound.assign(model_.clauses[i].begin(), model_.clauses[i].end());
    const auto t = model_.clause_timepoints[i];
    if (t > 0) bound.push_back(~reaches(t));
    visit(bound);
  }
  for (Timepoint t = 1; t < model_.horizon; ++t) {
    const Literal clause[] = {~reaches(t + 1), reaches(t)};
    visit(clause);
  }
}

void ModelQuestion::add(std::span<const Literal> clause) {
  more_.add(clause);
  solver_->add_clause(clause);
}

void ModelQuestion::imply(Literal condition, Literal consequence) {
  const Literal clause[] = {~condition, consequence};
  add(clause);
}

SolveStatus ModelQuestion::solve(std::vector<Literal> assumptions) {
  assumed_ = std::move(assumptions);
  for (const auto literal : assumed_) solver_->assume(literal);
  return solver_->solve();
}

void ModelQuestion::for_each_clause(const Visit& visit) const {
  visit_model(visit);
  for (std::size_t i = 0; i < more_.size(); ++i) visit(more_[i]);
  for (const auto literal : assumed_) visit(std::span(&literal, 1));
}

std::string ModelQuestion::comment() const { return fmt::format("c No model: {}\n", claim_); }

}  // namespace parallax::runtime
