// Formulas that say less of earlier timepoints at a longer horizon.
//
// A model is asked about at a horizon: timepoints behind it do not exist, nor do events at it, and
// an instance that names one says nothing. Where such an instance would have been one more thing to
// be true, a longer horizon only says more, and what holds up to a horizon holds up to it at any
// longer one. Where it would have been one more way to be true (below `{..}`, in the condition of
// an effect or of a completed predicate), a longer horizon takes back what the shorter one said.
// The rule looks for such places: instances that may reach beyond the horizon while all that is
// outside of their quantifier exists.
//
// Upper bounds of variables are read off the comparisons that stand beside them, as `time1<time`.
// One walk through the formula, and one through the body of each quantifier.

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/base/codes/names.h"
#include "compiler/lint/rules.h"
#include "compiler/sema/axiom_shapes.h"

namespace parallax::compiler {
namespace {

/// `variable + number`, or the number alone.
struct Linear {
  std::optional<VariableId> variable;
  std::int64_t number = 0;
};

class HorizonRule {
 public:
  explicit HorizonRule(const LintContext& context)
      : context_(context), model_(context.model()), core_(model_.core) {
    if (!core_.time) return;
    for (const auto& range : model_.sorts[*core_.time].ranges) last_ = std::max(last_, range.upper);
  }

  void run() {
    if (!core_.time) return;
    for (const auto& axiom : model_.axioms) {
      if (context_.built_in(axiom.source)) continue;
      reset();
      look(axiom.formula, true, false);
      if (why_.empty() && !defines_by_effects(model_, axiom)) look_at_reasons(axiom);
      report(axiom.source);
    }
    for (const auto& effect : model_.effects) {
      if (context_.built_in(effect.source)) continue;
      reset();
      look_at_effect(effect);
      report(effect.source);
    }
  }

 private:
  /// Variables known to be no later than the horizon, or before it, at any horizon.
  struct Bounds {
    std::set<std::uint32_t> within, before;  // by index
  };

  void reset() {
    why_.clear();
    outer_ = {};
  }
  void report(const base::SourceRange& source) {
    if (!why_.empty()) context_.sink().warning(codes::kDependsOnHorizon, source, why_);
  }

  bool is_time(SortId sort) const { return model_.is_subsort(sort, *core_.time); }
  std::string name(VariableId variable) const { return model_.variables[variable].name; }

  std::optional<Linear> linear(TermId id) const {
    const auto& term = model_.terms[id];
    if (term.kind == TermKind::kVariable) return Linear{term.variable, 0};
    if (term.kind == TermKind::kInteger) return Linear{std::nullopt, term.integer};
    if (term.kind != TermKind::kArithmetic) return std::nullopt;
    const bool minus = term.op == ArithmeticOp::kSubtract;
    if (!minus && term.op != ArithmeticOp::kAdd) return std::nullopt;
    const auto left = linear(term.arguments[0]), right = linear(term.arguments[1]);
    if (!left || !right || (left->variable && right->variable) || (minus && right->variable)) {
      return std::nullopt;
    }
    constexpr std::int64_t kMost = 1'000'000'000;
    // The least integer has no absolute value.
    const auto is_far = [](std::int64_t number) { return number > kMost || number < -kMost; };
    if (is_far(left->number) || is_far(right->number)) return std::nullopt;
    return Linear{left->variable ? left->variable : right->variable,
                  left->number + (minus ? -right->number : right->number)};
  }

  /// The time of an atom about one, and whether it is an event's.
  std::optional<TermId> time_of(const TypedFormula& atom, bool& event) const {
    const auto& p = atom.predicate;
    event =
        p == core_.happens || p == core_.initiates || p == core_.terminates || p == core_.releases;
    if (event) return atom.terms.back();
    if (p == core_.holds_at || p == core_.released_at) return atom.terms[1];
    return std::nullopt;
  }

  /// Collects the conjuncts of the formula, or of its negation if it is not `wanted`.
  void conjuncts(TypedFormulaId id, bool wanted, std::vector<const TypedFormula*>& out) const {
    const auto& formula = model_.formulas[id];
    const auto each = [&](bool value) {
      for (const auto child : formula.children) conjuncts(child, value, out);
    };
    switch (formula.kind) {
      case FormulaKind::kCompare:
        if (wanted) out.push_back(&formula);
        return;
      case FormulaKind::kAnd:
        if (wanted) each(true);
        return;
      case FormulaKind::kOr:
        if (!wanted) each(false);
        return;
      case FormulaKind::kNot:
        each(!wanted);
        return;
      case FormulaKind::kImplies:
        if (wanted) return;
        conjuncts(formula.children[0], true, out);
        conjuncts(formula.children[1], false, out);
        return;
      case FormulaKind::kExists:
        if (wanted) each(true);
        return;
      case FormulaKind::kForall:
        if (!wanted) each(false);
        return;
      case FormulaKind::kTrue:
      case FormulaKind::kFalse:
      case FormulaKind::kAtom:
      case FormulaKind::kIff:
      case FormulaKind::kAggregate:
      case FormulaKind::kTemporal:
        return;
    }
  }

  /// Adds the bound that a comparison `left < right + more` gives the variable on its left.
  static bool bound(const Linear& left, const Linear& right, std::int64_t more, std::int64_t last,
                    Bounds& bounds) {
    if (!left.variable) return false;
    const auto by = right.number + more - left.number;  // variable < right's variable + by
    bool within = false, before = false;
    if (!right.variable) {
      within = by <= last + 1;
      before = by <= last;
    } else if (bounds.before.contains(right.variable->index())) {
      within = by <= 2;
      before = by <= 1;
    } else if (bounds.within.contains(right.variable->index())) {
      within = by <= 1;
      before = by <= 0;
    }
    bool news = within && bounds.within.insert(left.variable->index()).second;
    if (before) news = bounds.before.insert(left.variable->index()).second || news;
    return news;
  }

  Bounds bounded_by(const std::vector<const TypedFormula*>& comparisons, Bounds bounds) const {
    for (bool news = true; news;) {
      news = false;
      for (const auto* comparison : comparisons) {
        const auto left = linear(comparison->terms[0]), right = linear(comparison->terms[1]);
        if (!left || !right) continue;
        switch (comparison->compare) {
          case CompareOp::kLess:
            news = bound(*left, *right, 0, last_, bounds) || news;
            break;
          case CompareOp::kLessEqual:
            news = bound(*left, *right, 1, last_, bounds) || news;
            break;
          case CompareOp::kGreater:
            news = bound(*right, *left, 0, last_, bounds) || news;
            break;
          case CompareOp::kGreaterEqual:
            news = bound(*right, *left, 1, last_, bounds) || news;
            break;
          case CompareOp::kEqual:
            news = bound(*left, *right, 1, last_, bounds) || news;
            news = bound(*right, *left, 1, last_, bounds) || news;
            break;
          case CompareOp::kNotEqual:
            break;
        }
      }
    }
    return bounds;
  }

  /// Can the time lie behind the horizon, or an event's at it, where the bounds hold?
  bool may_be_missing(TermId time, bool event, const Bounds& bounds) const {
    const auto& term = model_.terms[time];
    // A number is subtracted: the difference is no later.
    if (term.kind == TermKind::kArithmetic && term.op == ArithmeticOp::kSubtract && !linear(time)) {
      return may_be_missing(term.arguments[0], event, bounds);
    }
    const auto value = linear(time);
    if (!value) return true;
    const auto room = value->number + (event ? 1 : 0);
    if (!value->variable) return room > last_;
    if (bounds.before.contains(value->variable->index())) return room > 1;
    return !bounds.within.contains(value->variable->index()) || room > 0;
  }

  bool mentions(TermId root, const std::vector<VariableId>& variables) const {
    bool found = false;
    for_each_term(model_, root, [&](TermId id) {
      const auto& term = model_.terms[id];
      found = found ||
              (term.kind == TermKind::kVariable &&
               std::find(variables.begin(), variables.end(), term.variable) != variables.end());
    });
    return found;
  }

  /// One more instance would be one more way to be true: can there be one behind the horizon?
  /// `variables`: those of the instances; `everything`: atoms without them count as well, but for
  /// `head`. Gives the bounds inside.
  Bounds look_at_ways(const std::vector<VariableId>& variables, TypedFormulaId body, bool wanted,
                      bool everything, std::optional<TypedFormulaId> head = std::nullopt) {
    std::vector<const TypedFormula*> comparisons;
    conjuncts(body, wanted, comparisons);
    const auto bounds = bounded_by(comparisons, outer_);
    for (const auto variable : variables) {
      if (!is_time(model_.variables[variable].sort) || bounds.within.contains(variable.index()))
        continue;
      why_ = "`" + name(variable) + "` goes through all timepoints up to it";
      return bounds;
    }
    // Quantifiers below are looked at by themselves.
    std::vector<TypedFormulaId> todo = {body};
    while (!todo.empty() && why_.empty()) {
      const auto id = todo.back();
      const auto& formula = model_.formulas[id];
      todo.pop_back();
      if (!formula.variables.empty()) continue;
      todo.insert(todo.end(), formula.children.begin(), formula.children.end());
      if (formula.kind != FormulaKind::kAtom || head == id) continue;
      bool event = false;
      const auto time = time_of(formula, event);
      if (!time || !(everything || mentions(*time, variables))) continue;
      if (may_be_missing(*time, event, bounds)) {
        why_ = "`" + context_.text(formula.source) + "` may speak of a timepoint behind it";
      }
    }
    return bounds;
  }

  /// Notes which variables the instances of a quantifier leave, if all its atoms are to exist.
  Bounds inside(const std::vector<VariableId>& variables, TypedFormulaId body) const {
    auto bounds = outer_;
    for (const auto variable : variables) {
      if (is_time(model_.variables[variable].sort)) bounds.within.insert(variable.index());
    }
    std::vector<TypedFormulaId> todo = {body};
    while (!todo.empty()) {
      const auto& formula = model_.formulas[todo.back()];
      todo.pop_back();
      if (!formula.variables.empty()) continue;
      todo.insert(todo.end(), formula.children.begin(), formula.children.end());
      if (formula.kind != FormulaKind::kAtom) continue;
      bool event = false;
      const auto time = time_of(formula, event);
      const auto value = time ? linear(*time) : std::nullopt;
      if (value && value->variable && value->number + (event ? 1 : 0) > 0) {
        bounds.before.insert(value->variable->index());
      }
    }
    return bounds;
  }

  void look(TypedFormulaId id, bool positive, bool negative) {
    if (!why_.empty()) return;
    const auto& formula = model_.formulas[id];
    if (formula.kind == FormulaKind::kAggregate) return look_at_sum(formula, positive, negative);
    const bool exists = formula.kind == FormulaKind::kExists;
    if (exists || formula.kind == FormulaKind::kForall) {
      const auto body = formula.children[0];
      if (exists ? positive : negative) (void)look_at_ways(formula.variables, body, exists, false);
      const auto outside = outer_;
      outer_ = inside(formula.variables, body);
      look(body, positive, negative);
      outer_ = outside;
      return;
    }
    for (std::size_t i = 0; i < formula.children.size(); ++i) {
      const bool flips =
          formula.kind == FormulaKind::kNot || (formula.kind == FormulaKind::kImplies && i == 0);
      const bool both = formula.kind == FormulaKind::kIff;
      look(formula.children[i], both || (flips ? negative : positive),
           both || (flips ? positive : negative));
    }
  }

  /// More instances make `>=` true and `<=` false; they may turn a sum or an equation either way.
  void look_at_sum(const TypedFormula& formula, bool positive, bool negative) {
    const auto op = formula.compare;
    const bool counts = formula.terms.size() == 1;
    const bool rises = counts && (op == CompareOp::kGreater || op == CompareOp::kGreaterEqual);
    const bool falls = counts && (op == CompareOp::kLess || op == CompareOp::kLessEqual);
    const bool up = (!falls && positive) || (!rises && negative);
    const bool down = (!falls && negative) || (!rises && positive);
    if (up) (void)look_at_ways(formula.variables, formula.children[0], true, false);
    const auto outside = outer_;
    outer_ = inside(formula.variables, formula.children[0]);
    look(formula.children[0], up, down);
    outer_ = outside;
  }

  void know(TermId time, bool event) {
    const auto value = linear(time);
    if (!value || !value->variable) return;
    outer_.within.insert(value->variable->index());
    if (value->number + (event ? 1 : 0) > 0) outer_.before.insert(value->variable->index());
  }

  /// An effect at t is where its condition holds and exists, as far as t + 1 does.
  void look_at_effect(const EffectAxiom& effect) {
    know(effect.time, true);
    std::vector<VariableId> others;
    for (const auto variable : effect.variables) {
      if (outer_.within.contains(variable.index())) continue;
      const std::vector<VariableId> one = {variable};
      if (!mentions(effect.event, one) && !mentions(effect.fluent, one)) others.push_back(variable);
    }
    outer_ = look_at_ways(others, effect.condition, true, true);
    look(effect.condition, true, true);
  }

  /// Checks the reasons of a completed predicate: where the rest of the formula holds and exists.
  void look_at_reasons(const Axiom& axiom) {
    std::vector<VariableId> variables;
    auto body = axiom.formula;
    while (model_.formulas[body].kind == FormulaKind::kForall) {
      const auto& formula = model_.formulas[body];
      variables.insert(variables.end(), formula.variables.begin(), formula.variables.end());
      body = formula.children[0];
    }
    for (const auto id : positive_atoms(model_, axiom.formula)) {
      const auto& atom = model_.formulas[id];
      const bool completed =
          std::any_of(model_.completions.begin(), model_.completions.end(), [&](const auto& one) {
            return one.predicate == atom.predicate && (!one.label || *one.label == axiom.label);
          });
      if (!completed || !why_.empty()) continue;
      outer_ = {};
      bool event = false;
      if (const auto time = time_of(atom, event)) know(*time, event);
      std::vector<VariableId> others;
      for (const auto variable : variables) {
        const std::vector<VariableId> one = {variable};
        const bool in_head = std::any_of(atom.terms.begin(), atom.terms.end(),
                                         [&](TermId term) { return mentions(term, one); });
        if (in_head && is_time(model_.variables[variable].sort))
          outer_.within.insert(variable.index());
        if (!in_head) others.push_back(variable);
      }
      outer_ = look_at_ways(others, body, false, true, id);
      look(body, true, true);
    }
  }

  const LintContext& context_;
  const TypedModel& model_;
  const CoreSymbols& core_;
  std::int64_t last_ = 0;
  Bounds outer_;     // bounds outside of the quantifier at hand
  std::string why_;  // empty: nothing was found
};

}  // namespace

void find_horizon_dependences(const LintContext& context) { HorizonRule(context).run(); }

}  // namespace parallax::compiler
