#include "compiler/ground/step_facts.h"

#include <algorithm>
#include <optional>

namespace parallax::compiler {
namespace {

/// The event, if the formula is Happens(event, 0).
std::optional<std::uint32_t> event_of(FormulaId formula, const GroundModel& model) {
  const auto& formulas = model.formulas();
  if (formula.negated() || formulas.kind(formula) != FormulaNodeKind::kAtom) return std::nullopt;
  const auto& atom = model.atom(formulas.variable(formula));
  if (atom.kind != AtomKind::kHappens || atom.time != 0) return std::nullopt;
  return atom.index;
}

}  // namespace

StepFacts::StepFacts(const GroundModel& model) : model_(model) {
  for (const auto& constraint : model.constraints()) {
    if (constraint.width == 0 || constraint.width == 1) read(constraint.formula);
  }
}

void StepFacts::read(FormulaId formula) {
  const auto& formulas = model_.formulas();
  if (formulas.kind(formula) != FormulaNodeKind::kAnd) return;
  if (formula.negated()) return read_clause(formulas.children(formula));
  for (const auto part : formulas.children(formula)) {
    if (part.negated() && formulas.kind(part) == FormulaNodeKind::kAnd) {
      read_clause(formulas.children(part));
    }
  }
}

void StepFacts::read_clause(std::span<const FormulaId> negated_parts) {
  if (negated_parts.size() != 2) return;  // Happens(e) -> a | b says nothing of a single fluent
  const auto first = event_of(negated_parts[0], model_);
  const auto second = event_of(negated_parts[1], model_);
  if (first && second) {
    exclusive_.emplace(std::min(*first, *second), std::max(*first, *second));
  } else if (first) {
    preconditions_[*first].push_back(~negated_parts[1]);
  } else if (second) {
    preconditions_[*second].push_back(~negated_parts[0]);
  }
}

void StepFacts::add_literals(FormulaId formula, StateFacts& facts) const {
  const auto& formulas = model_.formulas();
  const auto note = [&](FormulaId part) {
    if (formulas.kind(part) != FormulaNodeKind::kAtom) return;
    const auto& atom = model_.atom(formulas.variable(part));
    if (atom.kind == AtomKind::kHoldsAt && atom.time == 0) facts[atom.index] = !part.negated();
  };
  note(formula);
  if (formulas.kind(formula) != FormulaNodeKind::kAnd || formula.negated()) return;
  for (const auto part : formulas.children(formula)) note(part);
}

StateFacts StepFacts::of(const EffectRow& row) const {
  StateFacts facts;
  const auto found = preconditions_.find(row.event);
  if (found != preconditions_.end()) {
    for (const auto formula : found->second) add_literals(formula, facts);
  }
  add_literals(row.condition, facts);
  return facts;
}

bool StepFacts::exclusive(std::uint32_t event, std::uint32_t other) const {
  return exclusive_.contains({std::min(event, other), std::max(event, other)});
}

bool StepFacts::implied(FormulaId formula, const StateFacts& facts) const {
  const auto value = evaluate(model_.formulas(), formula, [&](std::int32_t variable) {
    const auto& atom = model_.atom(variable);
    if (atom.kind != AtomKind::kHoldsAt || atom.time != 0) return Truth::kUnknown;
    const auto found = facts.find(atom.index);
    if (found == facts.end()) return Truth::kUnknown;
    return found->second ? Truth::kTrue : Truth::kFalse;
  });
  return value == Truth::kTrue;
}

}  // namespace parallax::compiler
