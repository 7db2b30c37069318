#include "compiler/ground/possible_atoms.h"

#include <algorithm>
#include <iterator>

namespace parallax::compiler {
namespace {

std::uint64_t occurrence_key(std::uint32_t event, Timepoint t) {
  return (static_cast<std::uint64_t>(event) << 32U) | static_cast<std::uint32_t>(t);
}

}  // namespace

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

}  // namespace parallax::compiler
