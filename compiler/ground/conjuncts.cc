#include "compiler/ground/conjuncts.h"

#include <utility>

namespace parallax::compiler {

std::vector<Conjunct> conjuncts_of(const TypedModel& model, TypedFormulaId root,
                                   bool root_negated) {
  std::vector<Conjunct> found;
  std::vector<std::pair<TypedFormulaId, bool>> todo = {{root, root_negated}};
  while (!todo.empty()) {
    const auto [id, negated] = todo.back();
    todo.pop_back();
    const auto& formula = model.formulas[id];
    const auto push_all = [&](bool sign) {
      for (std::size_t i = formula.children.size(); i-- > 0;) {
        todo.emplace_back(formula.children[i], sign);
      }
    };
    switch (formula.kind) {
      case FormulaKind::kCompare:
        found.push_back({Conjunct::Kind::kCompare, id, negated, {}, {}, false});
        break;
      case FormulaKind::kAtom:
        if (!negated) found.push_back({Conjunct::Kind::kAtom, id, false, {}, {}, false});
        break;
      case FormulaKind::kNot:
        push_all(!negated);
        break;
      case FormulaKind::kAnd:
        if (!negated) push_all(false);
        break;
      case FormulaKind::kOr:
        if (negated) push_all(true);
        break;
      case FormulaKind::kImplies:
        if (!negated) break;
        todo.emplace_back(formula.children[1], true);
        todo.emplace_back(formula.children[0], false);
        break;
      case FormulaKind::kTrue:
      case FormulaKind::kFalse:
      case FormulaKind::kIff:
      case FormulaKind::kForall:
      case FormulaKind::kExists:
      case FormulaKind::kAggregate:
      case FormulaKind::kTemporal:
        break;
    }
  }
  return found;
}

std::vector<Conjunct> meetings_in(const TypedModel& model, const std::vector<Conjunct>& conjuncts) {
  const auto& core = model.core;
  const auto is_same = [&](TermId a, TermId b) {
    const auto &left = model.terms[a], &right = model.terms[b];
    return a == b || (left.kind == TermKind::kVariable && right.kind == TermKind::kVariable &&
                      left.variable == right.variable);
  };
  std::vector<Conjunct> found;
  for (const auto& event : conjuncts) {
    if (event.kind != Conjunct::Kind::kAtom) continue;
    const auto& happens = model.formulas[event.formula];
    if (happens.predicate != core.happens) continue;
    for (const auto& fluent : conjuncts) {
      if (fluent.kind != Conjunct::Kind::kAtom) continue;
      const auto& holds = model.formulas[fluent.formula];
      if (holds.predicate != core.holds_at || !is_same(happens.terms[1], holds.terms[1])) continue;
      found.push_back(
          {Conjunct::Kind::kMeeting, event.formula, false, {}, {}, false, fluent.formula});
    }
  }
  return found;
}

std::vector<VariableId> variables_of(const TypedModel& model, TermId root) {
  std::vector<VariableId> found;
  std::vector<TermId> todo = {root};
  while (!todo.empty()) {
    const auto& term = model.terms[todo.back()];
    todo.pop_back();
    if (term.kind == TermKind::kVariable) found.push_back(term.variable);
    for (std::size_t i = term.arguments.size(); i-- > 0;) todo.push_back(term.arguments[i]);
  }
  return found;
}

std::vector<VariableId> variables_of(const TypedModel& model, TypedFormulaId root) {
  std::vector<VariableId> found;
  std::vector<TypedFormulaId> todo = {root};
  while (!todo.empty()) {
    const auto& formula = model.formulas[todo.back()];
    todo.pop_back();
    for (const auto term : formula.terms) {
      const auto own = variables_of(model, term);
      found.insert(found.end(), own.begin(), own.end());
    }
    todo.insert(todo.end(), formula.children.begin(), formula.children.end());
  }
  return found;
}

}  // namespace parallax::compiler
