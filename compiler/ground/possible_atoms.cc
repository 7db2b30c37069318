#include "compiler/ground/possible_atoms.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "compiler/base/contract.h"

namespace parallax::compiler {
namespace {

std::uint64_t occurrence_key(std::uint32_t event, Timepoint t) {
  return (static_cast<std::uint64_t>(event) << 32U) | static_cast<std::uint32_t>(t);
}

}  // namespace

void GroundTable::add(std::span<const GroundTermId> row) {
  PARALLAX_REQUIRE(row.size() == columns_, "a row has a value for every column");
  values_.insert(values_.end(), row.begin(), row.end());
  const auto number = static_cast<std::uint32_t>(rows_++);
  for (auto& [mask, index] : indexes_) note(index, mask, number);
}

std::uint64_t GroundTable::hash(std::span<const GroundTermId> key) {
  std::uint64_t h = 0x9e3779b97f4a7c15ULL;
  for (const auto value : key) {
    h ^= value.index();
    h *= 0xbf58476d1ce4e5b9ULL;
    h ^= h >> 29U;
  }
  return h;
}

void GroundTable::note(Index& index, std::uint64_t mask, std::uint32_t number) const {
  std::vector<GroundTermId> key;
  const auto values = row(number);
  for (std::size_t i = 0; i < columns_; ++i) {
    if (((mask >> i) & 1U) != 0) key.push_back(values[i]);
  }
  index[hash(key)].push_back(number);
}

/// Two keys of equal hash share a list: whoever reads the rows compares their values anyway.
std::span<const std::uint32_t> GroundTable::find(std::uint64_t mask,
                                                 std::span<const GroundTermId> key) {
  const auto [entry, added] = indexes_.try_emplace(mask);
  if (added) {
    for (std::uint32_t number = 0; number < rows_; ++number) note(entry->second, mask, number);
  }
  const auto found = entry->second.find(hash(key));
  if (found == entry->second.end()) return {};
  return found->second;
}

PossibleAtoms::PossibleAtoms(GroundModel& model)
    : model_(model), scheduled_(model.typed().symbols.size(), false) {}

GroundTable& PossibleAtoms::fluents(SymbolId symbol) {
  const auto& declared = model_.typed().symbols[symbol];
  const auto [entry, added] = fluents_.try_emplace(symbol, declared.arguments.size());
  if (added) {
    for (std::uint32_t f = 0; f < model_.fluents().size(); ++f) {
      const auto term = model_.fluents()[f];
      if (model_.terms()[term].symbol != symbol || !model_.may_hold(f)) continue;
      entry->second.add(model_.terms().arguments(term));
    }
  }
  return entry->second;
}

GroundTable& PossibleAtoms::events(SymbolId symbol) {
  const auto& declared = model_.typed().symbols[symbol];
  const bool timed = is_scheduled(symbol);
  const auto [entry, added] =
      events_.try_emplace({symbol, timed}, declared.arguments.size() + (timed ? 1 : 0));
  if (!added) return entry->second;
  if (timed) {
    for (const auto& [event, t] : occurrences_) {
      const auto term = model_.events()[event];
      if (model_.terms()[term].symbol != symbol) continue;
      const auto arguments = model_.terms().arguments(term);
      std::vector<GroundTermId> row(arguments.begin(), arguments.end());
      row.push_back(model_.terms().integer(t));
      entry->second.add(row);
    }
    return entry->second;
  }
  for (std::uint32_t e = 0; e < model_.events().size(); ++e) {
    const auto term = model_.events()[e];
    if (model_.terms()[term].symbol != symbol || !model_.may_happen(e)) continue;
    entry->second.add(model_.terms().arguments(term));
  }
  return entry->second;
}

GroundTable* PossibleAtoms::predicates(SymbolId symbol) {
  const auto found = predicates_.find(symbol);
  return found == predicates_.end() ? nullptr : &found->second;
}

void PossibleAtoms::schedule(const std::vector<bool>& symbols,
                             const std::vector<std::pair<std::uint32_t, Timepoint>>& occurrences) {
  scheduled_ = symbols;
  events_.clear();
  occurrences_ = occurrences;
  for (const auto& [event, t] : occurrences) occurrence_set_.insert(occurrence_key(event, t));
  std::vector<bool> occurs(model_.events().size(), false);
  for (const auto& [event, t] : occurrences) occurs[event] = true;
  all_scheduled_ = !model_.events().empty();
  for (std::uint32_t e = 0; e < model_.events().size(); ++e) {
    if (!is_scheduled(model_.terms()[model_.events()[e]].symbol)) {
      all_scheduled_ = false;
    } else if (!occurs[e]) {
      model_.never_happens(e);
    }
  }
}

void PossibleAtoms::track(std::uint32_t fluent, Timepoint from, bool may_hold) {
  auto& history = tracked_[fluent];
  if (history.empty() || history.back().second != may_hold) history.emplace_back(from, may_hold);
}

void PossibleAtoms::admit(std::uint32_t fluent) {
  model_.can_hold(fluent);
  const auto term = model_.fluents()[fluent];
  const auto table = fluents_.find(model_.terms()[term].symbol);
  if (table != fluents_.end()) table->second.add(model_.terms().arguments(term));
}

bool PossibleAtoms::may_hold(std::uint32_t fluent, std::optional<Timepoint> t) const {
  if (!model_.may_hold(fluent)) return false;
  const auto found = tracked_.find(fluent);
  if (!t || timeless_ || found == tracked_.end()) return true;
  const auto& history = found->second;
  const auto later =
      std::upper_bound(history.begin(), history.end(), *t,
                       [](Timepoint wanted, const auto& entry) { return wanted < entry.first; });
  return later == history.begin() || std::prev(later)->second;
}

bool PossibleAtoms::may_happen(std::uint32_t event, std::optional<Timepoint> t) const {
  if (!model_.may_happen(event)) return false;
  if (!t || !is_scheduled(model_.terms()[model_.events()[event]].symbol)) return true;
  return occurrence_set_.contains(occurrence_key(event, *t));
}

void PossibleAtoms::set_predicate_table(SymbolId symbol, GroundTable table) {
  auto& members = true_predicates_[symbol];
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    members.insert(model_.terms().apply(symbol, table.row(i)).index());
  }
  predicates_.insert_or_assign(symbol, std::move(table));
}

bool PossibleAtoms::may_be_true(SymbolId symbol, GroundTermId term) const {
  const auto found = true_predicates_.find(symbol);
  return found == true_predicates_.end() || found->second.contains(term.index());
}

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
