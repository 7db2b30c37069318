#include "compiler/artifact/compiled_model.h"

#include <algorithm>

namespace parallax::compiler {
namespace {

constexpr Timepoint kUntimed = -1;  // sorts before every timepoint

}  // namespace

std::vector<std::string> names_of(const std::vector<GroundName>& ground) {
  std::vector<std::string> names;
  for (const auto& one : ground) names.push_back(one.name);
  return names;
}

Atom CompiledModel::atom(std::int32_t v) const {
  PARALLAX_REQUIRE(v >= 1 && v <= variable_count(), "a variable of the model");
  if (v <= base()) return fixed[static_cast<std::size_t>(v) - 1];
  const auto place = v - base() - 1;
  const auto& slot = slots[static_cast<std::size_t>(place % stride())];
  return {slot.kind, slot.name, place / stride(), {}};
}

std::size_t CompiledModel::clause_count() const {
  if (!folded) return clauses.size();
  std::size_t count = 0;
  for (const auto& section : sections) {
    count += section.clauses * static_cast<std::size_t>(section.copies);
  }
  return count;
}

void CompiledModel::for_each_atom(const std::function<void(const AtomRef&)>& visit) const {
  const PlanAtom none;
  const auto show = [&](AtomKind kind, std::uint32_t slot, Timepoint t, const std::string& name,
                        std::size_t number) {
    visit({variable(slot, t), kind, t, name, none, static_cast<std::uint32_t>(number)});
  };
  for (Timepoint t = 0; t <= horizon; ++t) {
    for (std::size_t f = 0; f < fluents.size(); ++f) {
      if (fluents[f].slot) show(AtomKind::kHoldsAt, *fluents[f].slot, t, fluents[f].name, f);
    }
    for (std::size_t f = 0; f < release_slots.size(); ++f) {
      if (release_slots[f]) show(AtomKind::kReleasedAt, *release_slots[f], t, fluents[f].name, f);
    }
    if (t == horizon) break;
    for (std::size_t e = 0; e < events.size(); ++e) {
      if (events[e].slot) show(AtomKind::kHappens, *events[e].slot, t, events[e].name, e);
    }
  }
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    const auto& atom = fixed[i];
    if (is_nameless(atom.kind)) continue;
    auto number = i;
    if (atom.kind == AtomKind::kHappens) {
      const auto event = std::find_if(events.begin(), events.end(),
                                      [&](const GroundName& one) { return one.name == atom.name; });
      if (event == events.end()) continue;
      number = static_cast<std::size_t>(event - events.begin());
    }
    visit({static_cast<std::int32_t>(i) + 1, atom.kind, atom.time, atom.name, atom.plan,
           static_cast<std::uint32_t>(number)});
  }
}

std::optional<Literal> CompiledModel::of_slot(std::optional<std::uint32_t> slot,
                                              Timepoint t) const {
  if (!slot || t < 0 || t > (*slot < state_slots ? horizon : horizon - 1)) return std::nullopt;
  return Literal::positive(variable(*slot, t));
}

AtomIndex::AtomIndex(const CompiledModel& model) : model_(&model), fluents_(model.slots.size()) {
  for (std::size_t f = 0; f < model.fluents.size(); ++f) {
    const FluentId id(static_cast<std::uint32_t>(f));
    if (const auto slot = model.fluents[f].slot) fluents_[*slot] = id;
    if (f >= model.release_slots.size()) continue;
    if (const auto slot = model.release_slots[f]) fluents_[*slot] = id;
  }
  for (std::uint32_t slot = 0; slot < model.slots.size(); ++slot) {
    if (model.slots[slot].name.empty()) continue;
    slots_.emplace(std::pair(model.slots[slot].kind, model.slots[slot].name), slot);
  }
  for (std::size_t i = 0; i < model.fixed.size(); ++i) {
    const auto& atom = model.fixed[i];
    if (is_nameless(atom.kind)) continue;
    const auto time = atom.time.value_or(kUntimed);
    const auto variable = static_cast<std::int32_t>(i + 1);
    if (is_of_plan(atom.kind)) {
      plan_.emplace(std::tuple(atom.kind, time, atom.plan), variable);
    } else {
      fixed_.emplace(std::tuple(atom.kind, time, atom.name), variable);
    }
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

std::optional<FluentId> AtomIndex::fluent(std::int32_t variable) const {
  const auto place = variable - model_->base() - 1;
  if (place < 0) return std::nullopt;
  return fluents_[static_cast<std::size_t>(place % model_->stride())];
}

std::optional<Literal> AtomIndex::plan(AtomKind kind, const PlanAtom& plan, Timepoint t) const {
  const auto found = plan_.find(std::tuple(kind, t, plan));
  if (found == plan_.end()) return std::nullopt;
  return Literal::positive(found->second);
}

}  // namespace parallax::compiler
