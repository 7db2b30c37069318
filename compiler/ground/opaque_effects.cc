#include "compiler/ground/opaque_effects.h"

#include "compiler/formula/formula.h"

namespace parallax::compiler {

FormulaId OpaqueEffects::atom(const EffectKey& effect) {
  const auto found = atoms_.find(effect);
  if (found != atoms_.end()) return found->second;
  const auto& formulas = model_.formulas();
  const auto meaning = rows_.holds(effect.kind, effect.event, effect.fluent, effect.time, model_);
  if (formulas.kind(meaning) == FormulaNodeKind::kTrue) return meaning;
  const auto atom = model_.auxiliary_atom(effect.time);
  meaning_.emplace(formulas.variable(atom), meaning);
  atoms_.emplace(effect, atom);
  return atom;
}

FormulaId OpaqueEffects::resolved(FormulaId formula) const {
  if (meaning_.empty()) return formula;
  RewriteMemo memo;
  return rewrite_atoms(
      model_.formulas(), formula,
      [&](std::int32_t variable) {
        const auto found = meaning_.find(variable);
        return found == meaning_.end() ? model_.formulas().atom(variable) : found->second;
      },
      memo);
}

}  // namespace parallax::compiler
