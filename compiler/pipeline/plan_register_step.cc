#include "compiler/pipeline/plan_register_step.h"

namespace parallax::compiler {

void require_at_most_one(const std::vector<FormulaId>& atoms, std::uint32_t origin,
                         GroundModel& model) {
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    for (std::size_t j = i + 1; j < atoms.size(); ++j) {
      model.require(model.formulas().disjunction(~atoms[i], ~atoms[j]), origin);
    }
  }
}

std::optional<FormulaId> RegisterStep::success(LocationId id) {
  const auto& location = graph_.locations[id];
  const auto& formula = formulas_.success[id.index()];
  const auto when = t_ + location.success.time_offset;
  const auto& source = location.success.source;
  ways_.clear();
  if (!location.result) return registers_.ground(formula, when, t_, source);
  std::vector<FormulaId> any;
  for (const auto& value : registers_.values(*location.result)) {
    const auto good = registers_.ground(formula, when, t_, source, value.term);
    if (!good) return std::nullopt;
    if (*good == model_.formulas().falsity()) continue;
    ways_.push_back({&value, *good});
    any.push_back(*good);
  }
  return model_.formulas().disjunction(std::move(any));
}

void RegisterStep::leave(LocationId id, FormulaId ok, FormulaId failed, std::uint32_t origin) {
  const auto& location = graph_.locations[id];
  if (location.result) pick(location, ok, origin);
  carry(liveness_.behind(location, true), location.result, ok, origin);
  carry(liveness_.behind(location, false), std::nullopt, failed, origin);
}

/// Any one of the objects that make the formula true is returned.
void RegisterStep::pick(const PlanLocation& location, FormulaId ok, std::uint32_t origin) {
  auto& formulas = model_.formulas();
  std::vector<FormulaId> some;
  for (const auto& way : ways_) {
    const auto chosen = registers_.returned(*way.value, t_ + 1);
    some.push_back(chosen);
    model_.require(formulas.implication(formulas.conjunction(ok, chosen), way.good), origin);
    auto& reasons =
        picked_.try_emplace(way.value->name, chosen, std::vector<FormulaId>()).first->second.second;
    reasons.push_back(ok);
  }
  model_.require(formulas.implication(ok, formulas.disjunction(std::move(some))), origin);
  if (!liveness_.behind(location, true).contains(*location.result)) return;
  std::size_t way = 0;
  for (const auto& value : registers_.values(*location.result)) {
    const bool possible = way < ways_.size() && ways_[way].value == &value;
    if (possible) ++way;
    const auto chosen = possible ? registers_.returned(value, t_ + 1) : model_.formulas().falsity();
    const auto held = registers_.holds(*location.result, value, t_ + 1);
    model_.require(formulas.implication(ok, formulas.equivalence(held, chosen)), origin);
  }
}

/// Registers that are read later keep their values, all but the one that has just been filled.
void RegisterStep::carry(const RegisterSet& live, std::optional<ModelValueId> fresh,
                         FormulaId condition, std::uint32_t origin) {
  auto& formulas = model_.formulas();
  for (const auto id : live) {
    live_[id].push_back(condition);
    if (fresh == id) continue;
    for (const auto& value : registers_.values(id)) {
      const auto after = formulas.conjunction(condition, registers_.holds(id, value, t_ + 1));
      model_.require(formulas.implication(after, registers_.holds(id, value, t_)), origin);
    }
  }
}

void RegisterStep::finish(std::uint32_t origin) {
  auto& formulas = model_.formulas();
  std::vector<FormulaId> chosen;
  for (auto& [name, entry] : picked_) {
    chosen.push_back(entry.first);
    model_.require(formulas.implication(entry.first, formulas.disjunction(std::move(entry.second))),
                   origin);
  }
  require_at_most_one(chosen, origin, model_);
  for (auto& [id, conditions] : live_) {
    const auto live = formulas.disjunction(std::move(conditions));
    std::vector<FormulaId> held;
    for (const auto& value : registers_.values(id)) {
      held.push_back(registers_.holds(id, value, t_ + 1));
      model_.require(formulas.implication(held.back(), live), origin);
    }
    model_.require(formulas.implication(live, formulas.disjunction(held)), origin);
    require_at_most_one(held, origin, model_);
  }
}

}  // namespace parallax::compiler
