#include "compiler/ground/effect_rows.h"

#include <utility>

namespace parallax::compiler {

void EffectRows::add_always(const EffectRow& row) {
  by_fluent_[row.fluent].push_back(static_cast<std::uint32_t>(always_.size()));
  always_.push_back(row);
}

void EffectRows::add(Timepoint t, const EffectRow& row) {
  auto& rows = single_[t];
  single_by_fluent_[{t, row.fluent}].push_back(static_cast<std::uint32_t>(rows.size()));
  rows.push_back(row);
  irregular_.insert(row.fluent);
}

FormulaId EffectRows::changed(EffectKind kind, std::uint32_t fluent, Timepoint t,
                              GroundModel& model) const {
  std::vector<FormulaId> triggers;
  const auto trigger = [&](const EffectRow& row, Timepoint shift) {
    if (row.kind != kind) return;
    const auto condition = model.shifted(row.condition, shift);
    triggers.push_back(model.formulas().conjunction(model.happens(row.event, t), condition));
  };
  for (const auto number : by_fluent_[fluent]) trigger(always_[number], t);
  const auto found = single_by_fluent_.find({t, fluent});
  if (found != single_by_fluent_.end()) {
    for (const auto number : found->second) trigger(single_.at(t)[number], 0);
  }
  return model.formulas().disjunction(std::move(triggers));
}

FormulaId EffectRows::holds(EffectKind kind, std::uint32_t event, std::uint32_t fluent, Timepoint t,
                            GroundModel& model) const {
  std::vector<FormulaId> conditions;
  for (const auto number : by_fluent_[fluent]) {
    const auto& row = always_[number];
    if (row.kind == kind && row.event == event) {
      conditions.push_back(model.shifted(row.condition, t));
    }
  }
  const auto found = single_by_fluent_.find({t, fluent});
  if (found != single_by_fluent_.end()) {
    for (const auto number : found->second) {
      const auto& row = single_.at(t)[number];
      if (row.kind == kind && row.event == event) conditions.push_back(row.condition);
    }
  }
  return model.formulas().disjunction(std::move(conditions));
}

}  // namespace parallax::compiler
