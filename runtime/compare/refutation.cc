// "These observables are no trace of the model" as clauses of another model's solver.
//
// The model's variables become literals of a shared circuit: observed ones those of the first
// model, gates and forced variables the functions that define them (definitions.cc), free ones
// values that the caller requires. A violation literal of a clause implies that all its literals
// are false; some violation of each requirement has to be true. Clauses that hold by definition,
// follow from others, or are equal to a clause of the first model cannot be violated and are
// left out: the call looks only at what the models do not have in common. Violations are grouped
// by timepoint, so that later ones can be switched off.
//
// Cost: linear in the clauses; for each required valuation again in those over free variables.

#include "runtime/compare/refutation.h"

#include <map>

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
  literals.reserve(model_->clauses[index].size());
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
  children.reserve(definition.children.size());
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

using compiler::Timepoint;

Refutation::Refutation(const compiler::CompiledModel& model, const Definitions& definitions,
                       Circuit& circuit, SatSolver& solver, const ClauseSet& asserted,
                       const std::function<Literal(std::int32_t)>& observed,
                       const std::vector<Violations>& impossible)
    : model_(model),
      definitions_(definitions),
      circuit_(circuit),
      solver_(solver),
      asserted_(asserted),
      mapped_(model, definitions, circuit, [&](std::int32_t variable) -> std::optional<Literal> {
        const auto role = definitions.of[static_cast<std::size_t>(variable) - 1].role;
        if (role == Role::kFree) return std::nullopt;
        return observed(variable);
      }) {
  std::map<Timepoint, std::vector<Literal>> found;
  for (const auto& atom : impossible) found[atom.time].push_back(atom.some);
  for (std::size_t c = 0; c < model.clauses.size(); ++c) {
    if (!is_relevant(c)) continue;
    const auto clause = mapped_.clause(c);
    if (clause) {
      add(found, c, *clause);
    } else {
      open_.push_back(c);
    }
  }
  closed_ = grouped(found);
  all_ = closed_;
}

/// Is the clause needed? Those that follow from other clauses, or hold by definition, never are.
bool Refutation::is_relevant(std::size_t clause) const {
  if (definitions_.is_gate_clause[clause]) return false;
  return model_.origins[model_.clause_origins[clause]].kind != compiler::OriginKind::kInvariant;
}

void Refutation::add(std::map<Timepoint, std::vector<Literal>>& found, std::size_t clause,
                     const Circuit::Clause& mapped) {
  if (mapped.satisfied || asserted_.contains(mapped)) return;
  auto& violations = found[model_.clause_timepoints[clause]];
  if (mapped.literals.empty()) return violations.push_back(circuit_.truth());
  if (mapped.literals.size() == 1) return violations.push_back(~mapped.literals.front());
  const auto violated = circuit_.new_variable();
  for (const auto literal : mapped.literals) {
    const Literal falsified[] = {~violated, ~literal};
    solver_.add_clause(falsified);
  }
  violations.push_back(violated);
}

std::vector<Refutation::Violations> Refutation::grouped(
    const std::map<Timepoint, std::vector<Literal>>& found) {
  std::vector<Violations> out;
  for (const auto& [time, literals] : found) {
    const auto some = circuit_.new_variable();
    auto clause = literals;
    clause.push_back(~some);
    solver_.add_clause(clause);
    out.push_back({time, some});
  }
  return out;
}

void Refutation::require(const std::function<bool(std::int32_t)>& free_value) {
  auto required = closed_;
  if (!open_.empty()) {
    const auto closed = mapped_.closed(free_value);
    std::map<Timepoint, std::vector<Literal>> found;
    for (const auto c : open_) add(found, c, *closed.clause(c));
    const auto more = grouped(found);
    required.insert(required.end(), more.begin(), more.end());
    all_.insert(all_.end(), more.begin(), more.end());
  }
  std::vector<Literal> clause;
  for (const auto& violations : required) clause.push_back(violations.some);
  solver_.add_clause(clause);
}

void Refutation::assume_by(Timepoint by) const {
  for (const auto& violations : all_) {
    if (violations.time > by) solver_.assume(~violations.some);
  }
}

}  // namespace parallax::runtime
