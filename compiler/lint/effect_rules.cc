#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "compiler/base/codes/names.h"
#include "compiler/lint/rules.h"

namespace parallax::compiler {

namespace {

/// Why the 2005 reasoner stops at the arguments of this event or fluent, if it does.
std::optional<std::string> bad_arguments(const LintContext& context, TermId id, bool fluent) {
  const auto& model = context.model();
  const Term& term = model.terms[id];
  if (term.kind != TermKind::kApply) return std::nullopt;
  std::vector<VariableId> seen;
  for (const auto argument : term.arguments) {
    const Term& what = model.terms[argument];
    const auto quoted = "`" + context.text(what.source) + "`";
    if (what.kind != TermKind::kVariable) return quoted + " is no variable";
    if (fluent && std::find(seen.begin(), seen.end(), what.variable) != seen.end()) {
      return quoted + " stands twice in the fluent";
    }
    seen.push_back(what.variable);
  }
  return std::nullopt;
}

/// Arithmetic with an operand that has to be computed first, and not from numbers alone.
bool is_nested(const TypedModel& model, const Term& term) {
  if (term.kind != TermKind::kArithmetic) return false;
  bool nested = false, varies = false;
  for (const auto argument : term.arguments) {
    const auto kind = model.terms[argument].kind;
    nested = nested || kind == TermKind::kArithmetic || kind == TermKind::kApply;
    for_each_term(model, argument, [&](TermId id) {
      varies = varies || model.terms[id].kind == TermKind::kVariable;
    });
  }
  return nested && varies;
}

std::optional<TermId> nested_arithmetic(const TypedModel& model, TermId root) {
  std::optional<TermId> found;
  for_each_term(model, root, [&](TermId id) {
    if (!found && is_nested(model, model.terms[id])) found = id;
  });
  return found;
}

/// In the condition or in one of the terms of the effect.
std::optional<TermId> nested_arithmetic(const TypedModel& model, const EffectAxiom& effect) {
  std::optional<TermId> found;
  for_each_formula(model, effect.condition, [&](TypedFormulaId id) {
    for (const auto term : model.formulas[id].terms) {
      if (!found) found = nested_arithmetic(model, term);
    }
  });
  for (const auto term : {effect.event, effect.fluent, effect.time}) {
    if (!found) found = nested_arithmetic(model, term);
  }
  return found;
}

}  // namespace

void find_effect_arguments(const LintContext& context) {
  for (const auto& effect : context.model().effects) {
    // With a label it is no effect axiom for the 2005 reasoner (W2001).
    if (!effect.label.empty()) continue;
    auto reason = bad_arguments(context, effect.event, false);
    if (!reason) reason = bad_arguments(context, effect.fluent, true);
    if (!reason) continue;
    context.sink().warning(codes::kEffectArguments, effect.source, *reason);
  }
}

void find_noninertial_effects(const LintContext& context) {
  const auto& model = context.model();
  for (const auto& effect : model.effects) {
    const Term& fluent = model.terms[effect.fluent];
    if (effect.kind == EffectKind::kReleases || fluent.kind != TermKind::kApply) continue;
    const auto& symbol = model.symbols[fluent.symbol];
    if (!symbol.noninertial) continue;
    context.sink()
        .warning(codes::kNoninertialEffect, effect.source, symbol.name)
        .note(symbol.declared, "the fluent is declared here");
  }
}

void find_nested_arithmetic(const LintContext& context) {
  const auto& model = context.model();
  for (const auto& effect : model.effects) {
    const auto found = nested_arithmetic(model, effect);
    if (!found) continue;
    const auto& source = model.terms[*found].source;
    context.sink().warning(codes::kNestedArithmetic, source, context.text(source));
  }
}

}  // namespace parallax::compiler
