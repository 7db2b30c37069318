#include <algorithm>

#include "compiler/reference/model_expander.h"

namespace parallax::compiler {

std::optional<ModelExpander::Node> ModelExpander::expand(TypedFormulaId id) {
  const auto& formula = model_.formulas[id];
  const auto before = out_.trees_.size();
  std::optional<Node> node;
  switch (formula.kind) {
    case FormulaKind::kTrue:
    case FormulaKind::kFalse:
      return FormulaTrees::constant(formula.kind == FormulaKind::kTrue);
    case FormulaKind::kAtom:
      return atom(formula);
    case FormulaKind::kCompare:
      return compare(formula);
    case FormulaKind::kForall:
    case FormulaKind::kExists:
      node = quantified(formula);
      break;
    case FormulaKind::kNot:
    case FormulaKind::kAnd:
    case FormulaKind::kOr:
    case FormulaKind::kImplies:
    case FormulaKind::kIff:
      node = connected(formula);
      break;
  }
  // What became a constant, or nothing, needs its parts no more.
  if (!node || *node == FormulaTrees::kTruth || *node == FormulaTrees::kFalsity) {
    out_.trees_.rewind(before);
  }
  return node;
}

std::optional<ModelExpander::Node> ModelExpander::connected(const TypedFormula& formula) {
  std::vector<Node> parts;
  for (const auto child : formula.children) {
    if (!budget_.spend()) return std::nullopt;
    const auto part = expand(child);
    if (!part) return std::nullopt;
    parts.push_back(*part);
  }
  return out_.trees_.connect(formula.kind, parts);
}

std::optional<ModelExpander::Node> ModelExpander::quantified(const TypedFormula& formula) {
  std::vector<Node> parts;
  bool tried = false, exists = false;
  const auto neutral = FormulaTrees::constant(formula.kind == FormulaKind::kForall);
  for_each(formula.variables, [&] {
    tried = true;
    const auto part = expand(formula.children[0]);
    exists = exists || part.has_value();
    if (part && *part != neutral) parts.push_back(*part);
  });
  if (tried && !exists) return std::nullopt;
  return out_.trees_.connect(
      formula.kind == FormulaKind::kForall ? FormulaKind::kAnd : FormulaKind::kOr, parts);
}

std::optional<ModelExpander::Node> ModelExpander::compare(const TypedFormula& formula) {
  const auto left = term(formula.terms[0]);
  const auto right = term(formula.terms[1]);
  if (!left || !right) return std::nullopt;
  if (formula.compare == CompareOp::kEqual) return FormulaTrees::constant(*left == *right);
  if (formula.compare == CompareOp::kNotEqual) return FormulaTrees::constant(*left != *right);
  const auto a = terms_.number(*left);
  const auto b = terms_.number(*right);
  if (!a || !b) return std::nullopt;  // only integers have an order
  switch (formula.compare) {
    case CompareOp::kLess:
      return FormulaTrees::constant(*a < *b);
    case CompareOp::kLessEqual:
      return FormulaTrees::constant(*a <= *b);
    case CompareOp::kGreater:
      return FormulaTrees::constant(*a > *b);
    case CompareOp::kGreaterEqual:
      return FormulaTrees::constant(*a >= *b);
    case CompareOp::kEqual:
    case CompareOp::kNotEqual:
      break;
  }
  return std::nullopt;
}

std::optional<ModelExpander::Node> ModelExpander::atom(const TypedFormula& formula) {
  const auto& symbol = model_.symbols[formula.predicate];
  const auto arguments = terms_.arguments(symbol, formula.terms, environment_);
  if (!arguments) return std::nullopt;
  const auto& core = model_.core;
  if (formula.predicate == core.happens) return event_atom(formula, *arguments);
  if (formula.predicate == core.holds_at || formula.predicate == core.released_at) {
    const auto fluent = out_.fluent(terms_.text((*arguments)[0]));
    const auto t = terms_.number((*arguments)[1]);
    if (!fluent || !t) return std::nullopt;
    const bool holds = formula.predicate == core.holds_at;
    return out_.trees_.atom(holds ? out_.holds(*fluent, *t) : out_.released(*fluent, *t));
  }
  if (formula.predicate == core.initiates) return effect_atom(EffectKind::kInitiates, *arguments);
  if (formula.predicate == core.terminates) {
    return effect_atom(EffectKind::kTerminates, *arguments);
  }
  if (formula.predicate == core.releases) return effect_atom(EffectKind::kReleases, *arguments);
  const auto text = terms_.applied(symbol, *arguments);
  const auto number = static_cast<std::uint32_t>(out_.atom_count());
  const auto [found, is_new] = out_.predicate_numbers_.emplace(text, number);
  if (is_new) out_.predicates_.push_back(text);
  return out_.trees_.atom(found->second);
}

/// Events before the last timepoint exist. Said of the last one by its number, an event does not
/// happen there.
std::optional<ModelExpander::Node> ModelExpander::event_atom(const TypedFormula& formula,
                                                             const std::vector<Value>& arguments) {
  const auto event = out_.event(terms_.text(arguments[0]));
  const auto t = terms_.number(arguments[1]);
  if (!event || !t) return std::nullopt;
  if (*t < out_.horizon_) return out_.trees_.atom(out_.happens(*event, *t));
  if (model_.terms[formula.terms[1]].kind == TermKind::kInteger) return FormulaTrees::kFalsity;
  return std::nullopt;
}

/// Completed by circumscription: some effect axiom says so.
std::optional<ModelExpander::Node> ModelExpander::effect_atom(EffectKind kind,
                                                              const std::vector<Value>& arguments) {
  const auto event = out_.event(terms_.text(arguments[0]));
  const auto fluent = out_.fluent(terms_.text(arguments[1]));
  const auto t = terms_.number(arguments[2]);
  if (!event || !fluent || !t || *t >= out_.horizon_ || !effects_known_) return std::nullopt;
  std::vector<Node> conditions;
  for (const auto& row : out_.rows(*fluent, *t)) {
    if (row.kind == kind && row.event == *event) conditions.push_back(row.condition.node);
  }
  return out_.trees_.connect(FormulaKind::kOr, conditions);
}

}  // namespace parallax::compiler
