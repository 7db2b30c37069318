#include "runtime/explain/execution_formula.h"

#include <utility>

namespace parallax::runtime {

using compiler::Literal;
using compiler::Timepoint;

ExecutionFormula::ExecutionFormula(const compiler::CompiledModel& model,
                                   std::optional<Observed> observed)
    : model_(model),
      observed_(std::move(observed)),
      variables_(model.variable_count() + (is_guarded() ? 2 * model.horizon : 0)) {}

Literal ExecutionFormula::reaches(Timepoint t) const {
  return Literal::positive(model_.variable_count() + t);
}

Literal ExecutionFormula::ends(Timepoint n) const {
  return Literal::positive(model_.variable_count() + model_.horizon + n);
}

std::span<const Literal> ExecutionFormula::clause(std::size_t index) {
  const auto t = model_.clause_timepoints[index];
  if (!is_guarded() || t == 0 || is_definition(index)) return model_.clauses[index];
  clause_.assign(model_.clauses[index].begin(), model_.clauses[index].end());
  clause_.push_back(~reaches(t));
  return clause_;
}

void ExecutionFormula::for_each_always(const std::function<void(std::span<const Literal>)>& visit) {
  for (std::size_t i = 0; i < model_.clauses.size(); ++i) {
    if (is_definition(i)) visit(model_.clauses[i]);
  }
  if (!observed_) {
    if (model_.has_constraints) choose_length(visit);
    return;
  }
  for (Timepoint t = 1; t <= model_.horizon; ++t) {
    const auto reached = t <= observed_->length ? reaches(t) : ~reaches(t);
    visit(std::span(&reached, 1));
  }
  for (const auto& fact : observed_->facts) visit(std::span(&fact, 1));
}

void ExecutionFormula::choose_length(
    const std::function<void(std::span<const Literal>)>& visit) const {
  const compiler::AtomIndex index(model_);
  std::vector<Literal> some;
  for (Timepoint n = 1; n <= model_.horizon; ++n) {
    some.push_back(ends(n));
    const auto hit = index.hit(n);
    PARALLAX_REQUIRE(hit.has_value(), "every timepoint from 1 has its hit atom");
    const Literal hits[] = {~ends(n), *hit};
    const Literal reached[] = {~ends(n), reaches(n)};
    visit(hits);
    visit(reached);
    if (n == 1) continue;
    const Literal before[] = {~reaches(n), reaches(n - 1)};
    visit(before);
  }
  visit(some);
}

}  // namespace parallax::runtime
