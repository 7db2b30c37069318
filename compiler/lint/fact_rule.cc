#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "compiler/base/codes/names.h"
#include "compiler/lint/rules.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

namespace {

/// Pairs of a fact and a rule that are compared in one model.
constexpr std::size_t kMostPairs = 2'000'000;

/// An atom of a completed predicate that its axiom can be a reason for.
struct Reason {
  TypedFormulaId atom;
  const Axiom* axiom = nullptr;
  std::map<std::uint32_t, TermId> equations;  // variable -> constant, from a condition in front
};

class FactSearch {
 public:
  explicit FactSearch(const LintContext& context)
      : context_(context), model_(context.model()), domains_(model_) {}

  void check(const Completion& completion) {
    facts_.clear();
    rules_.clear();
    for (const auto& axiom : model_.axioms) {
      const bool counts = !axiom.mentions_effects && !context_.built_in(axiom.source) &&
                          (!completion.label || axiom.label == *completion.label);
      if (counts) collect(axiom, completion.predicate);
    }
    for (const auto& fact : facts_) report(fact);
  }

 private:
  /// `[v] P(..)` is a fact, every other formula with a positive P a rule.
  void collect(const Axiom& axiom, SymbolId predicate) {
    auto id = axiom.formula;
    while (model_.formulas[id].kind == FormulaKind::kForall) id = model_.formulas[id].children[0];
    const auto& body = model_.formulas[id];
    if (body.kind == FormulaKind::kAtom) {
      if (body.predicate == predicate) facts_.push_back({id, &axiom, {}});
      return;
    }
    for (const auto atom : positive_atoms(model_, axiom.formula)) {
      if (model_.formulas[atom].predicate != predicate) continue;
      rules_[head(atom)].push_back({atom, &axiom, equations(body)});
    }
  }

  /// The constructor of the first argument, so that facts meet only rules for the same event.
  std::optional<SymbolId> head(TypedFormulaId atom) const {
    const auto& terms = model_.formulas[atom].terms;
    if (terms.empty()) return std::nullopt;
    const Term& first = model_.terms[terms[0]];
    const bool named = first.kind == TermKind::kApply &&
                       model_.symbols[first.symbol].kind != SymbolKind::kFunction;
    return named ? std::optional(first.symbol) : std::nullopt;
  }

  std::map<std::uint32_t, TermId> equations(const TypedFormula& body) const {
    std::map<std::uint32_t, TermId> found;
    if (body.kind != FormulaKind::kImplies) return found;
    std::vector<TypedFormulaId> stack = {body.children[0]};
    while (!stack.empty()) {
      const auto& formula = model_.formulas[stack.back()];
      stack.pop_back();
      if (formula.kind == FormulaKind::kAnd) {
        stack.insert(stack.end(), formula.children.begin(), formula.children.end());
      } else if (formula.kind == FormulaKind::kCompare && formula.compare == CompareOp::kEqual) {
        for (const std::size_t side : {0U, 1U}) {
          const Term& variable = model_.terms[formula.terms[side]];
          const Term& constant = model_.terms[formula.terms[1 - side]];
          const bool fixed =
              constant.kind == TermKind::kObject || constant.kind == TermKind::kInteger;
          if (variable.kind != TermKind::kVariable || !fixed) continue;
          found.emplace(variable.variable.index(), formula.terms[1 - side]);
        }
      }
    }
    return found;
  }

  void report(const Reason& fact) {
    const auto symbol = head(fact.atom);
    const Reason* rule = symbol ? find(fact, rules_[symbol]) : nullptr;
    if (rule == nullptr) rule = find(fact, rules_[std::nullopt]);
    for (auto it = rules_.begin(); !symbol && rule == nullptr && it != rules_.end(); ++it) {
      rule = find(fact, it->second);
    }
    if (rule == nullptr) return;
    context_.sink()
        .warning(codes::kFactBesideRule, fact.axiom->source,
                 context_.text(model_.formulas[fact.atom].source))
        .note(rule->axiom->source, "the rule stands here");
  }

  const Reason* find(const Reason& fact, const std::vector<Reason>& rules) {
    for (const auto& rule : rules) {
      if (++pairs_ > kMostPairs) return nullptr;
      if (same_instance(fact, rule)) return &rule;
    }
    return nullptr;
  }

  /// Can the two atoms have an instance in common? Yes where that is not plainly impossible.
  bool same_instance(const Reason& fact, const Reason& rule) {
    std::vector<std::pair<TermId, TermId>> pairs;
    const auto push = [&](const std::vector<TermId>& left, const std::vector<TermId>& right) {
      for (std::size_t i = 0; i < left.size() && i < right.size(); ++i) {
        pairs.emplace_back(left[i], right[i]);
      }
    };
    push(model_.formulas[fact.atom].terms, model_.formulas[rule.atom].terms);
    while (!pairs.empty()) {
      const auto [left, given] = pairs.back();
      pairs.pop_back();
      auto right = given;
      if (model_.terms[right].kind == TermKind::kVariable) {
        const auto known = rule.equations.find(model_.terms[right].variable.index());
        if (known != rule.equations.end()) right = known->second;
      }
      const Term& a = model_.terms[left];
      const Term& b = model_.terms[right];
      if (!compatible(a, b)) return false;
      const bool constructors = is_constructor(a) && is_constructor(b);
      if (constructors) push(a.arguments, b.arguments);
    }
    return true;
  }

  bool is_constructor(const Term& term) const {
    return term.kind == TermKind::kApply &&
           model_.symbols[term.symbol].kind != SymbolKind::kFunction;
  }

  bool compatible(const Term& a, const Term& b) {
    const auto open = [&](const Term& term) {
      return term.kind == TermKind::kArithmetic ||
             (term.kind == TermKind::kApply && !is_constructor(term));
    };
    if (open(a) || open(b)) return true;
    if (a.kind == TermKind::kVariable) return lies_in(b, model_.variables[a.variable].sort);
    if (b.kind == TermKind::kVariable) return lies_in(a, model_.variables[b.variable].sort);
    if (a.kind != b.kind) return false;
    if (a.kind == TermKind::kObject) return a.object == b.object;
    if (a.kind == TermKind::kInteger) return a.integer == b.integer;
    return a.symbol == b.symbol;
  }

  bool lies_in(const Term& term, SortId sort) {
    if (term.kind == TermKind::kInteger) return domains_.contains(sort, term.integer);
    if (term.kind == TermKind::kVariable) {
      return domains_.overlap(model_.variables[term.variable].sort, sort);
    }
    if (term.kind == TermKind::kObject) {
      for (const auto own : model_.objects[term.object].sorts) {
        if (domains_.overlap(own, sort)) return true;
      }
      return false;
    }
    const auto& result = model_.symbols[term.symbol].result;
    return result && domains_.overlap(*result, sort);
  }

  const LintContext& context_;
  const TypedModel& model_;
  SortDomains domains_;
  std::vector<Reason> facts_;
  std::map<std::optional<SymbolId>, std::vector<Reason>> rules_;
  std::size_t pairs_ = 0;
};

}  // namespace

void find_facts_beside_rules(const LintContext& context) {
  FactSearch search(context);
  for (const auto& completion : context.model().completions) search.check(completion);
}

}  // namespace parallax::compiler
