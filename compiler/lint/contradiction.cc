// Conditions that never hold, as far as their conjuncts show it.
//
// Negations are pushed in as far as conjuncts go, and the conjuncts are gone through once with
// four tables: bounds of terms that are compared with numbers, constants that terms are equated
// with or differ from, pairs of terms that are equal or different, and atoms with their signs.
// Terms that are written alike denote the same, and different constants differ. The first
// conjunct that contradicts a table is the reason. Nothing is solved and no constant is
// propagated, so a condition may be contradictory for deeper reasons; what is reported is
// certain. Cost: linear in the condition, times a logarithm for the tables.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "compiler/base/codes/names.h"
#include "compiler/lint/rules.h"

namespace parallax::compiler {
namespace {

/// One conjunct without its negation signs.
struct AtomLiteral {
  TypedFormulaId formula;
  bool negated = false;
};

CompareOp opposite(CompareOp op) {
  switch (op) {
    case CompareOp::kEqual:
      return CompareOp::kNotEqual;
    case CompareOp::kNotEqual:
      return CompareOp::kEqual;
    case CompareOp::kLess:
      return CompareOp::kGreaterEqual;
    case CompareOp::kLessEqual:
      return CompareOp::kGreater;
    case CompareOp::kGreater:
      return CompareOp::kLessEqual;
    case CompareOp::kGreaterEqual:
      return CompareOp::kLess;
  }
  return op;
}

class Search {
 public:
  explicit Search(const LintContext& context) : context_(context), model_(context.model()) {}

  std::optional<std::string> run(TypedFormulaId condition) {
    for (const auto& literal : conjuncts(condition)) {
      const auto& formula = model_.formulas[literal.formula];
      std::optional<std::string> reason;
      if (formula.kind == FormulaKind::kCompare) {
        const auto op = literal.negated ? opposite(formula.compare) : formula.compare;
        reason = comparison(formula, op);
      } else if (formula.kind == FormulaKind::kAtom) {
        reason = atom(literal, formula);
      } else if ((formula.kind == FormulaKind::kFalse) != literal.negated &&
                 (formula.kind == FormulaKind::kTrue || formula.kind == FormulaKind::kFalse)) {
        reason = "it is false";
      }
      if (reason) return reason;
    }
    return std::nullopt;
  }

 private:
  struct Bounds {
    std::int64_t lower = std::numeric_limits<std::int64_t>::min();
    std::int64_t upper = std::numeric_limits<std::int64_t>::max();
  };

  std::vector<AtomLiteral> conjuncts(TypedFormulaId root) const {
    std::vector<AtomLiteral> found;
    std::vector<AtomLiteral> stack = {{root, false}};
    while (!stack.empty()) {
      const AtomLiteral next = stack.back();
      stack.pop_back();
      const auto& formula = model_.formulas[next.formula];
      const auto kind = formula.kind;
      const bool splits = next.negated ? kind == FormulaKind::kOr
                                       : kind == FormulaKind::kAnd || kind == FormulaKind::kExists;
      if (kind == FormulaKind::kNot) {
        stack.push_back({formula.children[0], !next.negated});
      } else if (splits) {
        for (auto child = formula.children.rbegin(); child != formula.children.rend(); ++child) {
          stack.push_back({*child, next.negated});
        }
      } else {
        found.push_back(next);
      }
    }
    return found;
  }

  /// Equal for terms that denote the same wherever they stand.
  std::string key(TermId root) const {
    std::string out;
    for_each_term(model_, root, [&](TermId id) {
      const auto& term = model_.terms[id];
      switch (term.kind) {
        case TermKind::kVariable:
          out += 'v' + std::to_string(term.variable.index());
          break;
        case TermKind::kObject:
          out += 'o' + std::to_string(term.object.index());
          break;
        case TermKind::kInteger:
          out += 'i' + std::to_string(term.integer);
          break;
        case TermKind::kApply:
          out += 'a' + std::to_string(term.symbol.index());
          break;
        case TermKind::kArithmetic:
          out += 'r' + std::to_string(static_cast<int>(term.op));
          break;
      }
    });
    return out;
  }

  /// Constants and terms built of them by constructors: different ones denote different things.
  bool is_constant(TermId root) const {
    bool constant = true;
    for_each_term(model_, root, [&](TermId id) {
      const auto& term = model_.terms[id];
      const bool varies = term.kind == TermKind::kVariable || term.kind == TermKind::kArithmetic ||
                          (term.kind == TermKind::kApply &&
                           model_.symbols[term.symbol].kind == SymbolKind::kFunction);
      constant = constant && !varies;
    });
    return constant;
  }

  std::string quoted(TermId term) const {
    return "`" + context_.text(model_.terms[term].source) + "`";
  }
  std::optional<std::int64_t> number(TermId term) const {
    if (model_.terms[term].kind != TermKind::kInteger) return std::nullopt;
    return model_.terms[term].integer;
  }

  std::optional<std::string> comparison(const TypedFormula& formula, CompareOp op) {
    auto left = formula.terms[0], right = formula.terms[1];
    if (key(left) == key(right)) {
      const bool never =
          op == CompareOp::kNotEqual || op == CompareOp::kLess || op == CompareOp::kGreater;
      if (never) return quoted(left) + " is compared with itself";
      return std::nullopt;
    }
    const auto x = number(left), y = number(right);
    if (x && y) {
      if (compares(*x, op, *y)) return std::nullopt;
      return "`" + context_.text(formula.source) + "` is false";
    }
    if (is_constant(left) && is_constant(right)) {
      if (op != CompareOp::kEqual) return std::nullopt;
      return quoted(left) + " and " + quoted(right) + " are different";
    }
    if (is_constant(left)) {
      std::swap(left, right);
      op = mirrored(op);
    }
    if (!is_constant(right)) return related(left, op, right);
    if (const auto bound = number(right); bound && op != CompareOp::kNotEqual) {
      if (auto reason = bounded(left, op, *bound)) return reason;
    }
    return equated(left, op, right);
  }

  /// Two terms that vary: only `x=y` beside `x!=y` is plain.
  std::optional<std::string> related(TermId left, CompareOp op, TermId right) {
    auto a = key(left), b = key(right);
    if (b < a) std::swap(a, b);
    if (op != CompareOp::kEqual && op != CompareOp::kNotEqual) return std::nullopt;
    const bool equal = op == CompareOp::kEqual;
    const auto [known, is_new] = related_.emplace(a + '=' + b, equal);
    if (is_new || known->second == equal) return std::nullopt;
    return quoted(left) + " and " + quoted(right) + " would be equal and different";
  }

  std::optional<std::string> equated(TermId left, CompareOp op, TermId right) {
    auto& entry = constants_[key(left)];
    const auto value = key(right);
    if (op == CompareOp::kNotEqual) {
      entry.excluded.insert(value);
    } else if (op == CompareOp::kEqual) {
      if (entry.value && key(*entry.value) != value) {
        return quoted(left) + " would be " + quoted(*entry.value) + " and " + quoted(right);
      }
      entry.value = right;
    }
    if (entry.value && entry.excluded.contains(key(*entry.value))) {
      return quoted(left) + " would be " + quoted(*entry.value) + " and something else";
    }
    return std::nullopt;
  }

  std::optional<std::string> bounded(TermId term, CompareOp op, std::int64_t bound) {
    auto& bounds = bounds_[key(term)];
    const bool below = op == CompareOp::kLess || op == CompareOp::kLessEqual;
    const bool above = op == CompareOp::kGreater || op == CompareOp::kGreaterEqual;
    // At the ends of 64 bits nothing is below or above.
    const bool strict = op == CompareOp::kLess || op == CompareOp::kGreater;
    const auto edge =
        below ? std::numeric_limits<std::int64_t>::min() : std::numeric_limits<std::int64_t>::max();
    if (strict && bound == edge) return quoted(term) + " has no value there";
    if (!above) bounds.upper = std::min(bounds.upper, strict ? bound - 1 : bound);
    if (!below) bounds.lower = std::max(bounds.lower, strict ? bound + 1 : bound);
    if (bounds.lower <= bounds.upper) return std::nullopt;
    return "no number is left for " + quoted(term);
  }

  std::optional<std::string> atom(const AtomLiteral& literal, const TypedFormula& formula) {
    std::string name = std::to_string(formula.predicate.index());
    for (const auto term : formula.terms) name += ',' + key(term);
    const auto [known, is_new] = atoms_.emplace(std::move(name), literal.negated);
    if (is_new || known->second == literal.negated) return std::nullopt;
    return "`" + context_.text(formula.source) + "` would be true and false";
  }

  struct Constants {
    std::optional<TermId> value;
    std::set<std::string> excluded;
  };

  const LintContext& context_;
  const TypedModel& model_;
  std::map<std::string, Constants> constants_;
  std::map<std::string, Bounds> bounds_;
  std::map<std::string, bool> related_;
  std::map<std::string, bool> atoms_;
};

/// True if it was reported.
bool report_contradiction(const LintContext& context, TypedFormulaId condition) {
  const auto reason = contradiction(context, condition);
  if (!reason) return false;
  context.sink().warning(codes::kConditionNeverHolds, context.model().formulas[condition].source,
                         *reason);
  return true;
}

}  // namespace

std::optional<std::string> contradiction(const LintContext& context, TypedFormulaId condition) {
  return Search(context).run(condition);
}

void find_impossible_conditions(const LintContext& context) {
  const auto& model = context.model();
  for (const auto& effect : model.effects) report_contradiction(context, effect.condition);
  for (const auto& path : model.trajectories) report_contradiction(context, path.condition);
  for (const auto& axiom : model.axioms) {
    if (context.built_in(axiom.source)) continue;
    bool reported = false;
    for_each_formula(model, axiom.formula, [&](TypedFormulaId id) {
      const auto& formula = model.formulas[id];
      if (reported || formula.kind != FormulaKind::kImplies) return;
      reported = report_contradiction(context, formula.children[0]);
    });
  }
}

}  // namespace parallax::compiler
