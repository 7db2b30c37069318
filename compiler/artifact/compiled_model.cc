#include "compiler/artifact/compiled_model.h"

namespace parallax::compiler {
namespace {
constexpr Timepoint kUntimed = -1;  // sorts before every timepoint
}

std::vector<std::string> names_of(const std::vector<GroundName>& ground) {
  std::vector<std::string> names;
  for (const auto& one : ground) names.push_back(one.name);
  return names;
}

std::string plan_cut_atom(std::size_t number) { return "BOUND(" + std::to_string(number) + ")"; }

Atom CompiledModel::atom(std::int32_t v) const {
  PARALLAX_REQUIRE(v >= 1 && v <= variable_count(), "a variable of the model");
  if (v <= base()) return fixed[static_cast<std::size_t>(v) - 1];
  const auto place = v - base() - 1;
  const auto& slot = slots[static_cast<std::size_t>(place % stride())];
  return {slot.kind, slot.name, place / stride()};
}

void CompiledModel::for_each_atom(
    const std::function<void(std::int32_t, AtomKind, const std::string&, std::optional<Timepoint>)>&
        visit) const {
  for (Timepoint t = 0; t <= horizon; ++t) {
    for (const auto& fluent : fluents) {
      if (fluent.slot) visit(variable(*fluent.slot, t), AtomKind::kHoldsAt, fluent.name, t);
    }
    for (std::size_t f = 0; f < release_slots.size(); ++f) {
      if (!release_slots[f]) continue;
      visit(variable(*release_slots[f], t), AtomKind::kReleasedAt, fluents[f].name, t);
    }
    if (t == horizon) break;
    for (const auto& event : events) {
      if (event.slot) visit(variable(*event.slot, t), AtomKind::kHappens, event.name, t);
    }
  }
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    const auto& atom = fixed[i];
    if (atom.kind == AtomKind::kAuxiliary || atom.kind == AtomKind::kUnused) continue;
    visit(static_cast<std::int32_t>(i) + 1, atom.kind, atom.name, atom.time);
  }
}

AtomIndex::AtomIndex(const CompiledModel& model) : model_(&model) {
  for (std::uint32_t slot = 0; slot < model.slots.size(); ++slot) {
    if (model.slots[slot].name.empty()) continue;
    slots_.emplace(std::pair(model.slots[slot].kind, model.slots[slot].name), slot);
  }
  for (std::size_t i = 0; i < model.fixed.size(); ++i) {
    const auto& atom = model.fixed[i];
    if (atom.kind == AtomKind::kAuxiliary || atom.kind == AtomKind::kUnused) continue;
    fixed_.emplace(std::tuple(atom.kind, atom.time.value_or(kUntimed), atom.name),
                   static_cast<std::int32_t>(i + 1));
  }
}

std::optional<Literal> AtomIndex::find(AtomKind kind, std::string_view name,
                                       std::optional<Timepoint> time) const {
  if (time) {
    const auto slot = slots_.find(std::pair(kind, std::string(name)));
    if (slot != slots_.end()) {
      const auto last = slot->second < model_->state_slots ? model_->horizon : model_->horizon - 1;
      if (*time < 0 || *time > last) return std::nullopt;
      return Literal::positive(model_->variable(slot->second, *time));
    }
  }
  const auto found = fixed_.find(std::tuple(kind, time.value_or(kUntimed), std::string(name)));
  if (found == fixed_.end()) return std::nullopt;
  return Literal::positive(found->second);
}

}  // namespace parallax::compiler
