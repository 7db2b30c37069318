// An upper bound on the atoms that can be true, as tables that joins run over.
//
// User predicates: unit propagation over the constraints found so far, together with completion,
// is repeated until nothing is learned; an atom that is false then gets no row. Fluents: a
// fluent that is false at first holds later only if some row initiates it whose condition may be
// true given the fluents reached so far. Rows are tried until no further fluent is reached;
// nothing is ever removed (the delete relaxation of planning), so what is not reached is false
// in every trace. Events and tracked fluents have bounds by timepoint, from the narrative.
//
// A table finds the rows for some bound columns by a hash index that is built with the first
// question for these columns. Cost: each round is linear in the constraints or rows; a predicate
// costs the product of its sorts, which is limited.

#include "compiler/ground/possible_atoms.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "compiler/base/contract.h"
#include "compiler/formula/formula.h"
#include "compiler/ground/time_profile.h"

namespace parallax::compiler {
namespace {

std::uint64_t occurrence_key(std::uint32_t event, Timepoint t) {
  return (static_cast<std::uint64_t>(event) << 32U) | static_cast<std::uint32_t>(t);
}

constexpr std::int64_t kLargestTable = 200'000;

class Tabulator {
 public:
  Tabulator(GroundModel& model, const CompletionWriter& completion, PossibleAtoms& possible)
      : model_(model), completion_(completion), possible_(possible) {
    const auto& typed = model.typed();
    for (const auto& axiom : typed.axioms) {
      if (time_profile(typed, axiom.formula).shape != TimeShape::kRigid) {
        note_predicates(axiom.formula);
      }
    }
  }

  void run(bool fold) {
    values_.assign(model_.atom_count() + 1, Truth::kUnknown);
    while (propagate()) {
    }
    const auto& typed = model_.typed();
    for (std::size_t i = 0; i < typed.symbols.size(); ++i) {
      const auto symbol = typed.symbols.id_at(i);
      if (typed.symbols[symbol].kind == SymbolKind::kPredicate && is_settled(symbol)) {
        tabulate(symbol);
      }
    }
    if (fold) fold_true_atoms();
  }

 private:
  /// A completed atom would lose reasons with the formulas that no longer mention it.
  void fold_true_atoms() {
    for (std::size_t i = 0; i < model_.atom_count(); ++i) {
      const auto variable = static_cast<std::int32_t>(i + 1);
      const auto& atom = model_.atom(variable);
      if (atom.kind != AtomKind::kPredicate || value(variable) != Truth::kTrue) continue;
      const auto term = GroundTermId(atom.index);
      if (completion_.completion_of(model_.terms()[term].symbol) == nullptr) {
        model_.note_true_predicate(term);
      }
    }
  }
  void note_predicates(TypedFormulaId root) {
    std::vector<TypedFormulaId> todo = {root};
    while (!todo.empty()) {
      const auto& formula = model_.typed().formulas[todo.back()];
      todo.pop_back();
      todo.insert(todo.end(), formula.children.begin(), formula.children.end());
      if (formula.kind == FormulaKind::kAtom) timed_.insert(formula.predicate.index());
    }
  }
  bool is_closed(SymbolId symbol) const {
    return completion_.completion_of(symbol) != nullptr && !timed_.contains(symbol.index());
  }
  Truth value(std::int32_t variable) const { return values_[static_cast<std::size_t>(variable)]; }
  bool set(FormulaId literal) {
    const auto& formulas = model_.formulas();
    if (formulas.kind(literal) != FormulaNodeKind::kAtom) return false;
    auto& slot = values_[static_cast<std::size_t>(formulas.variable(literal))];
    if (slot != Truth::kUnknown) return false;
    slot = literal.negated() ? Truth::kFalse : Truth::kTrue;
    return true;
  }

  /// One round of unit propagation; true if it learned something.
  bool propagate() {
    bool learned = false;
    const auto& formulas = model_.formulas();
    for (const auto& constraint : model_.constraints()) {
      const auto id = constraint.formula;
      if (formulas.kind(id) == FormulaNodeKind::kAnd && !id.negated()) {
        for (const auto part : formulas.children(id)) learned |= propagate(part);
      } else {
        learned |= propagate(id);
      }
    }
    for (std::size_t i = 0; i < model_.atom_count(); ++i) {
      const auto variable = static_cast<std::int32_t>(i + 1);
      const auto& atom = model_.atom(variable);
      if (atom.kind != AtomKind::kPredicate || value(variable) != Truth::kUnknown) continue;
      if (!is_closed(model_.terms()[GroundTermId(atom.index)].symbol)) continue;
      if (evaluate(formulas, completion_.reason(atom), [&](std::int32_t v) { return value(v); }) !=
          Truth::kFalse) {
        continue;
      }
      values_[static_cast<std::size_t>(variable)] = Truth::kFalse;
      learned = true;
    }
    return learned;
  }

  bool propagate(FormulaId part) {
    const auto& formulas = model_.formulas();
    if (formulas.kind(part) == FormulaNodeKind::kAtom) return set(part);
    if (formulas.kind(part) != FormulaNodeKind::kAnd) return false;
    // A clause: a single literal that is left must be true.
    std::optional<FormulaId> open;
    for (const auto child : formulas.children(part)) {
      const auto known = evaluate(formulas, child, [&](std::int32_t v) { return value(v); });
      if (known == Truth::kFalse) return false;
      if (known == Truth::kTrue) continue;
      if (open) return false;
      open = child;
    }
    return open && set(~*open);
  }

  /// Is some atom of the predicate known to be false?
  bool is_settled(SymbolId symbol) const {
    if (is_closed(symbol)) return true;
    for (std::size_t i = 0; i < model_.atom_count(); ++i) {
      const auto variable = static_cast<std::int32_t>(i + 1);
      const auto& atom = model_.atom(variable);
      if (atom.kind == AtomKind::kPredicate && value(variable) == Truth::kFalse &&
          model_.terms()[GroundTermId(atom.index)].symbol == symbol) {
        return true;
      }
    }
    return false;
  }

  void tabulate(SymbolId symbol) {
    const auto& declared = model_.typed().symbols[symbol];
    std::int64_t size = 1;
    for (const auto sort : declared.arguments) {
      const auto count = static_cast<std::int64_t>(model_.universe().domain(sort).size());
      if (count == 0 || __builtin_mul_overflow(size, count, &size) || size > kLargestTable) return;
    }
    GroundTable table(declared.arguments.size());
    std::vector<std::size_t> odometer(declared.arguments.size(), 0);
    std::vector<GroundTermId> row(odometer.size());
    for (std::int64_t k = 0; k < size; ++k) {
      for (std::size_t a = 0; a < row.size(); ++a) {
        row[a] = model_.universe().domain(declared.arguments[a])[odometer[a]];
      }
      if (may_be_true(symbol, row)) table.add(row);
      for (std::size_t a = odometer.size(); a-- > 0;) {
        if (++odometer[a] < model_.universe().domain(declared.arguments[a]).size()) break;
        odometer[a] = 0;
      }
    }
    possible_.set_predicate_table(symbol, std::move(table));
  }

  bool may_be_true(SymbolId symbol, const std::vector<GroundTermId>& row) {
    const auto variable = model_.find_predicate(model_.terms().apply(symbol, row));
    if (!variable) return !is_closed(symbol);
    return static_cast<std::size_t>(*variable) >= values_.size() ||
           value(*variable) != Truth::kFalse;
  }

  GroundModel& model_;
  const CompletionWriter& completion_;
  PossibleAtoms& possible_;
  std::set<std::uint32_t> timed_;  // symbols that axioms about time mention
  std::vector<Truth> values_;      // by variable
};

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

/// Two keys of equal hash share a list: readers of the rows compare their values anyway.
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

const std::vector<std::uint32_t>& PossibleAtoms::numbers_of(SymbolId symbol,
                                                            const std::vector<GroundTermId>& terms,
                                                            BySymbol& index) const {
  if (index.numbers.empty() || index.terms != terms.size()) {
    index.terms = terms.size();
    index.numbers.assign(model_.typed().symbols.size(), {});
    for (std::uint32_t i = 0; i < terms.size(); ++i)
      index.numbers[model_.terms()[terms[i]].symbol.index()].push_back(i);
  }
  return index.numbers[symbol.index()];
}

GroundTable& PossibleAtoms::fluents(SymbolId symbol) {
  const auto& declared = model_.typed().symbols[symbol];
  const auto [entry, added] = fluents_.try_emplace(symbol, declared.arguments.size());
  if (added) {
    for (const auto f : numbers_of(symbol, model_.fluents(), fluent_numbers_)) {
      if (model_.may_hold(f)) entry->second.add(model_.terms().arguments(model_.fluents()[f]));
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
  for (const auto e : numbers_of(symbol, model_.events(), event_numbers_)) {
    if (model_.may_happen(e)) entry->second.add(model_.terms().arguments(model_.events()[e]));
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

void PossibleAtoms::know_effects() {
  const auto& core = model_.typed().core;
  for (const auto& predicate : {core.initiates, core.terminates, core.releases}) {
    if (predicate) predicates_.insert_or_assign(*predicate, GroundTable(2));
  }
}

bool PossibleAtoms::add_effect(EffectKind kind, std::uint32_t event, std::uint32_t fluent) {
  const auto& core = model_.typed().core;
  if (!effects_.emplace(kind, event, fluent).second) return false;
  const auto predicate = kind == EffectKind::kInitiates    ? core.initiates
                         : kind == EffectKind::kTerminates ? core.terminates
                                                           : core.releases;
  predicates_.at(*predicate).add(std::array{model_.events()[event], model_.fluents()[fluent]});
  return true;
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

void tabulate_predicates(GroundModel& model, const CompletionWriter& completion, bool fold,
                         PossibleAtoms& possible) {
  Tabulator(model, completion, possible).run(fold);
}

}  // namespace parallax::compiler
