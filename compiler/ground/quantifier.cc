#include <algorithm>

#include "compiler/ground/grounding_frame.h"

namespace parallax::compiler {
namespace {

bool is_quantifier(FormulaKind kind) {
  return kind == FormulaKind::kForall || kind == FormulaKind::kExists;
}

}  // namespace

void FormulaGrounder::begin_instances(Frame& frame, TypedFormulaId id) {
  for (const auto variable : frame.formula->variables) {
    if (!terms_.is_bound(variable)) frame.open.push_back(variable);
  }
  const auto ranges_over_nothing = [&](VariableId variable) {
    return model_->universe().domain(typed_->variables[variable].sort).empty();
  };
  if (std::any_of(frame.open.begin(), frame.open.end(), ranges_over_nothing)) {
    frame.exhausted = true;  // true or false, whatever stands inside
    return;
  }
  const auto& known = quantifier(id, frame);
  for (const auto atom : known.outer_atoms) {
    if (!beyond_horizon(typed_->formulas[atom])) continue;
    frame.discarded = frame.exhausted = true;
    return;
  }
  if (runnable(known.plan, frame.open)) {
    frame.instances = InstanceSearch(terms_, possible_).run(known.plan, frame.open);
  }
  frame.exhausted = failed() || !next_instance(frame);
}

/// What is too large is refused before it is begun: a bare product by its size, a join whose
/// expected size is beyond all reason.
bool FormulaGrounder::runnable(const InstancePlan& plan, const std::vector<VariableId>& open) {
  constexpr double kBeyondReason = 1000.0;
  const auto limit = static_cast<double>(terms_.options().max_instances);
  const bool fits = plan.estimate <= (plan.is_product ? limit : kBeyondReason * limit);
  return fits || open.empty() || spend(terms_.options().max_instances + 1);
}

const FormulaGrounder::Quantifier& FormulaGrounder::quantifier(TypedFormulaId id,
                                                               const Frame& frame) {
  const auto found = quantifiers_.find(id.index());
  if (found != quantifiers_.end()) return found->second;
  const bool negated = frame.formula->kind == FormulaKind::kForall;
  Quantifier made;
  made.plan = plan_instances(frame.open, conjuncts_of(*typed_, frame.formula->children[0], negated),
                             *model_, possible_, [&](VariableId v) { return terms_.is_bound(v); });
  if (meaning_ == Meaning::kStandard) made.outer_atoms = outer_atoms(*frame.formula);
  return quantifiers_.emplace(id.index(), std::move(made)).first->second;
}

/// Timed atoms in the body whose timepoint is fixed outside: where it does not exist, no instance
/// does.
std::vector<TypedFormulaId> FormulaGrounder::outer_atoms(const TypedFormula& root) const {
  std::vector<TypedFormulaId> found;
  std::vector<TypedFormulaId> todo = root.children;
  while (!todo.empty()) {
    const auto& formula = typed_->formulas[todo.back()];
    const auto id = todo.back();
    todo.pop_back();
    // What an inner quantifier makes of its instances is its own affair.
    if (is_quantifier(formula.kind)) continue;
    todo.insert(todo.end(), formula.children.begin(), formula.children.end());
    const auto& core = typed_->core;
    if (formula.kind != FormulaKind::kAtom) continue;
    if (formula.predicate != core.happens && formula.predicate != core.holds_at &&
        formula.predicate != core.released_at) {
      continue;
    }
    const auto all = variables_of(*typed_, formula.terms[1]);
    if (std::all_of(all.begin(), all.end(), [&](VariableId v) { return terms_.is_bound(v); })) {
      found.push_back(id);
    }
  }
  return found;
}

bool FormulaGrounder::beyond_horizon(const TypedFormula& formula) {
  const auto time = terms_.term(formula.terms[1]);
  if (!time) return true;
  const auto t = model_->terms()[*time].integer;
  if (t < 0 || t > model_->horizon()) return true;
  const bool named = typed_->terms[formula.terms[1]].kind == TermKind::kInteger;
  return formula.predicate == typed_->core.happens && t == model_->horizon() && !named;
}

bool FormulaGrounder::next_instance(Frame& frame) {
  if (frame.in_product) return next_of_product(frame);
  const auto width = frame.open.size();
  const auto count = width == 0 ? 1 : frame.instances.size() / width;
  if (frame.next < count) {
    for (std::size_t i = 0; i < width; ++i) {
      bind(frame.open[i], frame.instances[frame.next * width + i]);
    }
    ++frame.next;
    return spend(1);
  }
  // Every instance that could say anything has been seen. If none of them exists, the others
  // decide whether the formula itself does.
  if (frame.exists || meaning_ == Meaning::kDecreasoner) return false;
  frame.in_product = true;
  for (const auto variable : frame.open) {
    const auto& domain = model_->universe().domain(typed_->variables[variable].sort);
    bind(variable, domain[0]);
  }
  frame.odometer.assign(width, 0);
  return width > 0;
}

bool FormulaGrounder::next_of_product(Frame& frame) {
  for (std::size_t i = frame.open.size(); i-- > 0;) {
    const auto& domain = model_->universe().domain(typed_->variables[frame.open[i]].sort);
    if (++frame.odometer[i] < domain.size()) {
      bind(frame.open[i], domain[frame.odometer[i]]);
      return spend(1);
    }
    frame.odometer[i] = 0;
    bind(frame.open[i], domain[0]);
  }
  return false;
}

std::vector<GroundTermId> FormulaGrounder::instances(const std::vector<VariableId>& variables,
                                                     const std::vector<Conjunct>& conjuncts) {
  const auto plan = plan_instances(variables, conjuncts, *model_, possible_,
                                   [&](VariableId v) { return terms_.is_bound(v); });
  if (!runnable(plan, variables)) return {};
  return InstanceSearch(terms_, possible_).run(plan, variables);
}

}  // namespace parallax::compiler
