#include "compiler/ground/effect_rows.h"

namespace parallax::compiler {

FormulaId EffectRows::holds(EffectKind kind, std::uint32_t event, std::uint32_t fluent,
                            std::int32_t t, FormulaStore& formulas) const {
  std::vector<FormulaId> conditions;
  if (t >= 0 && static_cast<std::size_t>(t) < rows_.size()) {
    for (const auto& row : at(t)) {
      if (row.kind == kind && row.event == event && row.fluent == fluent) {
        conditions.push_back(row.condition);
      }
    }
  }
  return formulas.disjunction(std::move(conditions));
}

}  // namespace parallax::compiler
