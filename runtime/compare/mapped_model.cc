#include "runtime/compare/mapped_model.h"

namespace parallax::runtime {

MappedModel::MappedModel(const compiler::CompiledModel& model, const Definitions& definitions,
                         Circuit& circuit,
                         const std::function<std::optional<Literal>(std::int32_t)>& given)
    : model_(&model),
      definitions_(&definitions),
      circuit_(&circuit),
      literals_(definitions.of.size()) {
  for (std::size_t v = 0; v < literals_.size(); ++v) {
    const auto& definition = definitions.of[v];
    const auto variable = static_cast<std::int32_t>(v) + 1;
    if (definition.role == Role::kConstant) literals_[v] = circuit.constant(definition.value);
    if (definition.role == Role::kObserved || definition.role == Role::kFree) {
      literals_[v] = given(variable);
    }
  }
  for (const auto variable : definitions.order) define(variable);
}

MappedModel MappedModel::closed(const std::function<bool(std::int32_t)>& free_value) const {
  auto copy = *this;
  for (const auto variable : definitions_->free) {
    copy.literals_[static_cast<std::size_t>(variable) - 1] =
        circuit_->constant(free_value(variable));
  }
  for (const auto variable : definitions_->order) copy.define(variable);
  return copy;
}

std::optional<Literal> MappedModel::find(Literal literal) const {
  const auto& mapped = literals_[static_cast<std::size_t>(literal.var()) - 1];
  if (!mapped) return std::nullopt;
  return literal.is_positive() ? *mapped : ~*mapped;
}

std::optional<Circuit::Clause> MappedModel::clause(std::size_t index) const {
  std::vector<Literal> literals;
  for (const auto literal : model_->clauses[index]) {
    const auto mapped = find(literal);
    if (!mapped) return std::nullopt;
    literals.push_back(*mapped);
  }
  return circuit_->simplified(std::move(literals));
}

void MappedModel::define(std::int32_t variable) {
  auto& literal = literals_[static_cast<std::size_t>(variable) - 1];
  if (literal) return;
  const auto& definition = definitions_->of[static_cast<std::size_t>(variable) - 1];
  if (definition.role == Role::kGate) literal = gate(definition);
  if (definition.role == Role::kForced) literal = forced(variable, definition);
}

std::optional<Literal> MappedModel::gate(const Definition& definition) const {
  std::vector<Literal> children;
  for (const auto child : definition.children) {
    const auto mapped = find(child);
    if (!mapped) return std::nullopt;
    children.push_back(*mapped);
  }
  return circuit_->conjunction(std::move(children));
}

/// Has the value of its clauses where the rest of one of them is false.
std::optional<Literal> MappedModel::forced(std::int32_t variable,
                                           const Definition& definition) const {
  std::vector<Literal> reasons;
  for (const auto index : definition.clauses) {
    std::vector<Literal> rest;
    for (const auto literal : model_->clauses[index]) {
      if (literal.var() == variable) continue;
      const auto mapped = find(literal);
      if (!mapped) return std::nullopt;
      rest.push_back(~*mapped);
    }
    reasons.push_back(circuit_->conjunction(std::move(rest)));
  }
  const auto some = circuit_->disjunction(std::move(reasons));
  return definition.value ? some : ~some;
}

}  // namespace parallax::runtime
