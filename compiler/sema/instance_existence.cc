// Existence of instances, as formulas.
//
// An instance of a formula that names something outside of its sort, or a timepoint that the
// horizon cuts off, says nothing as a whole. Where a formula is taken apart into axioms, each of
// them has to exist with the others. `F -> F` says so in the language itself: it is true, and it
// has the instances of F. Every reader of the checked model understands it without a rule of its
// own. Effects are no atoms there; `Happens(e,t) & HoldsAt(f,t)` names what an effect names.

#include "compiler/sema/instance_existence.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace parallax::compiler {
namespace {

bool is_effect(const CoreSymbols& core, SymbolId predicate) {
  return predicate == core.initiates || predicate == core.terminates || predicate == core.releases;
}
bool is_trajectory(const CoreSymbols& core, SymbolId predicate) {
  return predicate == core.trajectory || predicate == core.anti_trajectory;
}

class LackSearch {
 public:
  LackSearch(const TypedModel& model, const std::set<std::uint32_t>& before_last)
      : model_(model), before_last_(before_last) {}

  bool formula(TypedFormulaId root) const {
    std::vector<TypedFormulaId> todo = {root};
    while (!todo.empty()) {
      const auto& formula = model_.formulas[todo.back()];
      todo.pop_back();
      todo.insert(todo.end(), formula.children.begin(), formula.children.end());
      if (formula.kind == FormulaKind::kAtom && atom(formula)) return true;
      const bool compares =
          formula.kind == FormulaKind::kCompare || formula.kind == FormulaKind::kAggregate;
      if (compares && std::any_of(formula.terms.begin(), formula.terms.end(),
                                  [&](TermId term) { return parts(term); })) {
        return true;
      }
    }
    return false;
  }

 private:
  bool atom(const TypedFormula& atom) const {
    const auto& core = model_.core;
    if (is_trajectory(core, atom.predicate)) return true;  // may end beyond the horizon
    const bool is_state = atom.predicate == core.holds_at || atom.predicate == core.released_at;
    const bool is_step = atom.predicate == core.happens || is_effect(core, atom.predicate);
    const auto& sorts = model_.symbols[atom.predicate].arguments;
    for (std::size_t i = 0; i < atom.terms.size(); ++i) {
      const bool is_time = (is_state || is_step) && i + 1 == atom.terms.size();
      const bool lacks =
          is_time ? timepoint(atom.terms[i], is_step) : term(atom.terms[i], sorts[i]);
      if (lacks) return true;
    }
    return false;
  }

  bool is_before_last(TermId id) const {
    const auto& term = model_.terms[id];
    return term.kind == TermKind::kVariable && before_last_.contains(term.variable.index());
  }

  bool timepoint(TermId id, bool is_step) const {
    const auto& term = model_.terms[id];
    if (is_before_last(id)) return false;
    if (is_step) return true;
    if (term.kind == TermKind::kArithmetic && term.op == ArithmeticOp::kAdd) {
      const auto& second = model_.terms[term.arguments[1]];
      return !(is_before_last(term.arguments[0]) && second.kind == TermKind::kInteger &&
               second.integer == 1);
    }
    if (term.kind == TermKind::kInteger) return term.integer != 0;
    return this->term(id, *model_.core.time);
  }

  /// Can the term have no value, or one outside of the sort?
  bool term(TermId id, SortId sort) const {
    const auto& term = model_.terms[id];
    switch (term.kind) {
      case TermKind::kVariable:
        return !model_.is_subsort(model_.variables[term.variable].sort, sort);
      case TermKind::kObject: {
        const auto& own = model_.objects[term.object].sorts;
        return std::none_of(own.begin(), own.end(),
                            [&](SortId one) { return model_.is_subsort(one, sort); });
      }
      case TermKind::kInteger:
        // Other numbers were looked at where the formula was checked.
        return term.integer != 0 && model_.core.time && model_.is_subsort(sort, *model_.core.time);
      case TermKind::kArithmetic:
        return true;
      case TermKind::kApply: {
        const auto& symbol = model_.symbols[term.symbol];
        if (symbol.kind == SymbolKind::kFunction) return true;  // its table may leave the sort
        return parts(id) || !symbol.result || !model_.is_subsort(*symbol.result, sort);
      }
    }
    return true;
  }

  /// Can a part of the term be missing, whatever sort the whole may have?
  bool parts(TermId root) const {
    std::vector<TermId> todo = {root};
    while (!todo.empty()) {
      const auto& term = model_.terms[todo.back()];
      todo.pop_back();
      if (term.kind == TermKind::kArithmetic) {
        // Sums and products always have a value.
        if (term.op == ArithmeticOp::kDivide || term.op == ArithmeticOp::kModulo) return true;
        todo.insert(todo.end(), term.arguments.begin(), term.arguments.end());
      }
      if (term.kind != TermKind::kApply) continue;
      const auto& sorts = model_.symbols[term.symbol].arguments;
      for (std::size_t i = 0; i < term.arguments.size(); ++i) {
        if (this->term(term.arguments[i], sorts[i])) return true;
      }
    }
    return false;
  }

  const TypedModel& model_;
  const std::set<std::uint32_t>& before_last_;
};

class ExistenceWriter {
 public:
  explicit ExistenceWriter(TypedModel& model) : model_(model) {}

  TypedFormulaId write(TypedFormulaId root) {
    const auto plain = without_effects(root);
    return join(FormulaKind::kImplies, {plain, plain}, root);
  }

 private:
  /// A copy of the formula in which effects and trajectories are replaced by what they name; the
  /// formula itself where it has none.
  TypedFormulaId without_effects(TypedFormulaId root) {
    struct Visit {
      TypedFormulaId id;
      std::size_t next = 0;
      std::vector<TypedFormulaId> made = {};
    };
    std::vector<Visit> stack = {{root}};
    TypedFormulaId result = root;
    while (!stack.empty()) {
      auto& visit = stack.back();
      // A copy: the store grows.
      const TypedFormula formula = model_.formulas[visit.id];
      if (visit.next < formula.children.size()) {
        const auto child = formula.children[visit.next++];
        stack.push_back({child});
        continue;
      }
      result = visit.id;
      if (formula.kind == FormulaKind::kAtom) {
        result = named(visit.id, formula);
      } else if (visit.made != formula.children) {
        auto copy = formula;
        copy.children = visit.made;
        result = model_.formulas.add(std::move(copy));
      }
      stack.pop_back();
      if (!stack.empty()) stack.back().made.push_back(result);
    }
    return result;
  }

  TypedFormulaId named(TypedFormulaId id, const TypedFormula& atom) {
    const auto& core = model_.core;
    const auto& terms = atom.terms;
    if (is_effect(core, atom.predicate)) {
      return join(FormulaKind::kAnd,
                  {timed(*core.happens, terms[0], terms[2], id),
                   timed(*core.holds_at, terms[1], terms[2], id)},
                  id);
    }
    if (!is_trajectory(core, atom.predicate)) return id;
    Term end;
    end.kind = TermKind::kArithmetic;
    end.op = ArithmeticOp::kAdd;
    end.arguments = {terms[1], terms[3]};
    end.source = model_.terms[terms[3]].source;
    const auto end_id = model_.terms.add(std::move(end));
    return join(FormulaKind::kAnd,
                {timed(*core.holds_at, terms[0], terms[1], id),
                 timed(*core.holds_at, terms[2], end_id, id)},
                id);
  }

  TypedFormulaId timed(SymbolId predicate, TermId what, TermId time, TypedFormulaId place) {
    TypedFormula atom;
    atom.kind = FormulaKind::kAtom;
    atom.predicate = predicate;
    atom.terms = {what, time};
    atom.source = model_.formulas[place].source;
    return model_.formulas.add(std::move(atom));
  }

  TypedFormulaId join(FormulaKind kind, std::vector<TypedFormulaId> children,
                      TypedFormulaId place) {
    TypedFormula formula;
    formula.kind = kind;
    formula.children = std::move(children);
    formula.source = model_.formulas[place].source;
    return model_.formulas.add(std::move(formula));
  }

  TypedModel& model_;
};

}  // namespace

bool may_lack_instances(const TypedModel& model, TypedFormulaId formula,
                        const std::set<std::uint32_t>& before_last) {
  return LackSearch(model, before_last).formula(formula);
}

void collect_event_times(const TypedModel& model, TypedFormulaId root,
                         std::set<std::uint32_t>& before_last) {
  std::vector<TypedFormulaId> todo = {root};
  while (!todo.empty()) {
    const auto& formula = model.formulas[todo.back()];
    todo.pop_back();
    if (formula.kind == FormulaKind::kAnd) {
      todo.insert(todo.end(), formula.children.begin(), formula.children.end());
    }
    if (formula.kind != FormulaKind::kAtom) continue;
    if (formula.predicate != model.core.happens && !is_effect(model.core, formula.predicate)) {
      continue;
    }
    const auto& time = model.terms[formula.terms.back()];
    if (time.kind == TermKind::kVariable) before_last.insert(time.variable.index());
  }
}

TypedFormulaId existence_formula(TypedModel& model, TypedFormulaId formula) {
  return ExistenceWriter(model).write(formula);
}

}  // namespace parallax::compiler
