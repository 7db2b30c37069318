// Tells whether a formula says the same at every timepoint.
//
// Timepoints are read as `variable + constant`. If all of them use one and the same universally
// quantified variable, the variable stands nowhere else, and none is a plain integer, the
// formula is uniform: the grounder makes one copy at the earliest timepoint and repeats it by
// moving variables. The least and the greatest constant give the value at which the earliest
// timepoint is 0 and the horizon that one copy needs; an event needs the timepoint after it as
// well. Anything else is fixed (integers alone), rigid (no timepoint) or mixed. Linear in the
// formula.

#include "compiler/ground/time_profile.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "compiler/ground/conjuncts.h"

namespace parallax::compiler {
namespace {

struct TimeTerm {
  std::optional<VariableId> variable;
  std::int64_t offset = 0;
};

/// `v`, `v + c`, `v - c`, `c + v` or an integer; none for anything else.
std::optional<TimeTerm> time_term(const TypedModel& model, TermId id) {
  const auto& term = model.terms[id];
  if (term.kind == TermKind::kVariable) return TimeTerm{term.variable, 0};
  if (term.kind == TermKind::kInteger) return TimeTerm{std::nullopt, term.integer};
  if (term.kind != TermKind::kArithmetic) return std::nullopt;
  const auto left = time_term(model, term.arguments[0]);
  const auto right = time_term(model, term.arguments[1]);
  if (!left || !right || (left->variable && right->variable)) return std::nullopt;
  std::int64_t offset = 0;
  if (term.op == ArithmeticOp::kAdd) {
    if (__builtin_add_overflow(left->offset, right->offset, &offset)) return std::nullopt;
    return TimeTerm{left->variable ? left->variable : right->variable, offset};
  }
  if (term.op != ArithmeticOp::kSubtract || right->variable) return std::nullopt;
  if (__builtin_sub_overflow(left->offset, right->offset, &offset)) return std::nullopt;
  return TimeTerm{left->variable, offset};
}

/// Which argument of the atom is a timepoint of the event calculus, and how far it reaches.
std::optional<std::size_t> time_argument(const TypedModel& model, SymbolId predicate) {
  const auto& core = model.core;
  if (predicate == core.holds_at || predicate == core.released_at || predicate == core.happens) {
    return 1;
  }
  if (predicate == core.initiates || predicate == core.terminates || predicate == core.releases) {
    return 2;
  }
  return std::nullopt;
}

/// Gathers the timepoints of a formula and every use of variables.
class Profiler {
 public:
  explicit Profiler(const TypedModel& model) : model_(model) {}

  void visit(TypedFormulaId root) {
    std::vector<TypedFormulaId> todo = {root};
    while (!todo.empty()) {
      const auto& formula = model_.formulas[todo.back()];
      todo.pop_back();
      todo.insert(todo.end(), formula.children.begin(), formula.children.end());
      if (formula.kind == FormulaKind::kCompare || formula.kind == FormulaKind::kAggregate) {
        for (const auto term : formula.terms) other_use(term);
      }
      if (formula.kind == FormulaKind::kAtom) visit_atom(formula);
    }
  }
  void visit_atom(const TypedFormula& atom) {
    const auto place = time_argument(model_, atom.predicate);
    for (std::size_t i = 0; i < atom.terms.size(); ++i) {
      if (i != place) other_use(atom.terms[i]);
    }
    if (!place) return;
    const bool is_step =
        atom.predicate != model_.core.holds_at && atom.predicate != model_.core.released_at;
    timepoint(atom.terms[*place], is_step ? 1 : 0);
  }
  void timepoint(TermId id, std::int64_t reach) {
    any_ = true;
    const auto term = time_term(model_, id);
    if (!term) {
      odd_ = true;
      return;
    }
    if (!term->variable) {
      literal_ = true;
      latest_ = std::max(latest_, term->offset);
      return;
    }
    if (variable_ && *variable_ != *term->variable) odd_ = true;
    variable_ = term->variable;
    least_ = std::min(least_, term->offset);
    most_ = std::max(most_, term->offset + reach);
  }
  void other_use(TermId term) {
    const auto all = variables_of(model_, term);
    others_.insert(others_.end(), all.begin(), all.end());
  }

  TimeProfile profile(const std::vector<VariableId>& universal) const {
    TimeProfile result;
    if (!any_) return result;
    result.shape = TimeShape::kMixed;
    constexpr std::int64_t kFar = 1'000'000;
    if (!odd_ && !variable_) result.shape = TimeShape::kFixed;
    if (!odd_ && !variable_) result.last = static_cast<Timepoint>(std::min(latest_, kFar));
    if (odd_ || literal_ || !variable_) return result;
    const auto variable = *variable_;
    const bool outermost =
        std::find(universal.begin(), universal.end(), variable) != universal.end();
    const bool elsewhere = std::find(others_.begin(), others_.end(), variable) != others_.end();
    if (!outermost || elsewhere || model_.variables[variable].sort != model_.core.time ||
        least_ < -kFar || most_ > kFar) {
      return result;
    }
    result.shape = TimeShape::kUniform;
    result.variable = variable;
    result.back = static_cast<Timepoint>(-least_);
    result.width = static_cast<Timepoint>(most_ - least_);
    return result;
  }

 private:
  const TypedModel& model_;
  bool any_ = false, odd_ = false, literal_ = false;
  std::optional<VariableId> variable_;
  // The variable is a timepoint itself, whatever the formula says of it.
  std::int64_t least_ = 0, most_ = 0;
  std::int64_t latest_ = 0;  // of the integers
  std::vector<VariableId> others_;
};

}  // namespace

TimeProfile time_profile(const TypedModel& model, TypedFormulaId root,
                         std::optional<VariableId> free) {
  Profiler profiler(model);
  profiler.visit(root);
  std::vector<VariableId> universal;
  if (free) universal.push_back(*free);
  auto id = root;
  while (model.formulas[id].kind == FormulaKind::kForall) {
    const auto& variables = model.formulas[id].variables;
    universal.insert(universal.end(), variables.begin(), variables.end());
    id = model.formulas[id].children[0];
  }
  return profiler.profile(universal);
}

TimeProfile time_profile(const TypedModel& model, const EffectAxiom& effect) {
  Profiler profiler(model);
  profiler.visit(effect.condition);
  profiler.other_use(effect.event);
  profiler.other_use(effect.fluent);
  profiler.timepoint(effect.time, 1);
  auto result = profiler.profile(effect.variables);
  const bool own_time = model.terms[effect.time].kind == TermKind::kVariable;
  if (result.shape == TimeShape::kUniform && (!own_time || result.back != 0 || result.width != 1)) {
    result.shape = TimeShape::kMixed;
  }
  return result;
}

}  // namespace parallax::compiler
