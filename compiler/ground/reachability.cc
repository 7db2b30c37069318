#include "compiler/ground/reachability.h"

#include <utility>

namespace parallax::compiler {

bool is_worth_leaving_out(const GroundModel& model, std::size_t keep) {
  return model.fluents().size() * static_cast<std::size_t>(model.horizon() + 1) > keep;
}

std::vector<Truth> initial_values(const GroundModel& model) {
  std::vector<Truth> values(model.fluents().size(), Truth::kUnknown);
  const auto& formulas = model.formulas();
  const auto note = [&](FormulaId id) {
    if (formulas.kind(id) != FormulaNodeKind::kAtom) return;
    const auto& atom = model.atom(formulas.variable(id));
    if (atom.kind != AtomKind::kHoldsAt || atom.time != 0) return;
    values[atom.index] = id.negated() ? Truth::kFalse : Truth::kTrue;
  };
  for (const auto& constraint : model.constraints()) {
    if (constraint.width != Constraint::kOnce) continue;
    note(constraint.formula);
    if (formulas.kind(constraint.formula) != FormulaNodeKind::kAnd ||
        constraint.formula.negated()) {
      continue;
    }
    for (const auto part : formulas.children(constraint.formula)) note(part);
  }
  return values;
}

void drop_unreachable(GroundModel& model, PossibleAtoms& possible, EffectRows& rows,
                      std::size_t keep) {
  const auto count = model.fluents().size();
  std::vector<bool> reached(count, true);
  const auto& formulas = model.formulas();
  const auto initial = initial_values(model);
  for (std::uint32_t f = 0; f < count; ++f) {
    reached[f] = model.may_hold(f) && (model.can_be_released(f) || initial[f] != Truth::kFalse);
  }
  // A condition on a timepoint after the event may hold through the event itself: unknown.
  const auto value_at = [&](const EffectRow& row, Timepoint t) {
    return evaluate(formulas, row.condition, [&](std::int32_t variable) {
      const auto& atom = model.atom(variable);
      const bool never =
          (atom.kind == AtomKind::kHoldsAt && atom.time <= t && !reached[atom.index]) ||
          (atom.kind == AtomKind::kHappens && !model.may_happen(atom.index));
      return never ? Truth::kFalse : Truth::kUnknown;
    });
  };
  std::vector<std::pair<const EffectRow*, Timepoint>> waiting;
  const auto wait = [&](const EffectRow& row, Timepoint t) {
    if (row.kind == EffectKind::kInitiates && !reached[row.fluent]) waiting.emplace_back(&row, t);
  };
  for (const auto& row : rows.always()) wait(row, 0);
  for (const auto& [t, list] : rows.single()) {
    for (const auto& row : list) wait(row, t);
  }
  for (bool grown = true; grown;) {
    grown = false;
    std::erase_if(waiting, [&](const auto& entry) {
      const auto& [row, t] = entry;
      if (reached[row->fluent]) return true;
      if (value_at(*row, t) == Truth::kFalse) return false;
      reached[row->fluent] = grown = true;
      return true;
    });
  }
  for (std::uint32_t f = 0; f < count; ++f) {
    if (!reached[f] && is_worth_leaving_out(model, keep)) model.never_holds(f);
  }
  rows.filter_always([&](const EffectRow& row) { return value_at(row, 0) != Truth::kFalse; });
  possible.forget_fluent_tables();
}

}  // namespace parallax::compiler
