#include "compiler/base/diagnostic_codes.h"
#include "compiler/lint/contradiction.h"
#include "compiler/lint/rules.h"

namespace parallax::compiler {

using base::DiagnosticCode;

namespace {

/// True if it was reported.
bool check(const LintContext& context, TypedFormulaId condition) {
  const auto reason = contradiction(context, condition);
  if (!reason) return false;
  context.sink().warning(DiagnosticCode::kConditionNeverHolds,
                         context.model().formulas[condition].source, *reason);
  return true;
}

}  // namespace

void find_impossible_conditions(const LintContext& context) {
  const auto& model = context.model();
  for (const auto& effect : model.effects) check(context, effect.condition);
  for (const auto& path : model.trajectories) check(context, path.condition);
  for (const auto& axiom : model.axioms) {
    if (context.built_in(axiom.source)) continue;
    bool reported = false;
    for_each_formula(model, axiom.formula, [&](TypedFormulaId id) {
      const auto& formula = model.formulas[id];
      if (reported || formula.kind != FormulaKind::kImplies) return;
      reported = check(context, formula.children[0]);
    });
  }
}

}  // namespace parallax::compiler
