// Atoms that always agree, or never do.
//
// A HoldsAt or ReleasedAt atom is described by its value at 0 and, for each event, by the
// condition under which the event makes it true and the one under which it makes it false. Two
// atoms with inertia and the same description agree at every timepoint, by induction; an atom
// that is true at 0 is described by its negation. (A thing's place is released exactly while the
// thing is carried.) Descriptions are compared as formulas of the store, where equal formulas
// have equal ids, so what is equal for deeper reasons is not found. Each atom is declared equal
// to the first one with its description, at every timepoint.
//
// Cost: linear in the effect rows but for the look-ups in one sorted table.

#include "compiler/ground/equal_bits.h"

#include <initializer_list>
#include <map>
#include <utility>
#include <vector>

#include "compiler/formula/formula.h"
#include "compiler/ground/possible_atoms.h"

namespace parallax::compiler {
namespace {

/// By event: the condition under which it makes a bit true (or false).
using Triggers = std::map<std::uint32_t, FormulaId>;
/// Triggers that make a bit true which is false at 0, and triggers that make it false.
using Behaviour = std::pair<Triggers, Triggers>;

class EqualBits {
 public:
  EqualBits(GroundModel& model, const EffectRows& rows)
      : model_(model), initial_(initial_values(model)), rows_of_(model.fluents().size()) {
    for (const auto& row : rows.always()) rows_of_[row.fluent].push_back(&row);
    for (std::uint32_t f = 0; f < rows_of_.size(); ++f) {
      const auto& symbol = model.fluent_symbol(f);
      if (symbol.noninertial || symbol.manual_release || !rows.is_uniform(f)) rows_of_[f].clear();
    }
  }

  void run() {
    // HoldsAt first, so that other bits are declared equal to a HoldsAt atom.
    for (std::uint32_t f = 0; f < rows_of_.size(); ++f) {
      if (!rows_of_[f].empty() && !model_.can_be_released(f)) add_holds(f);
    }
    for (std::uint32_t f = 0; f < rows_of_.size(); ++f) {
      if (!rows_of_[f].empty() && model_.can_be_released(f)) add_released(f);
    }
  }

 private:
  void add_holds(std::uint32_t fluent) {
    if (!model_.may_hold(fluent) || initial_[fluent] == Truth::kUnknown) return;
    const bool first = initial_[fluent] == Truth::kTrue;
    auto on = triggers(fluent, {EffectKind::kInitiates});
    auto off = triggers(fluent, {EffectKind::kTerminates});
    if (first) std::swap(on, off);
    const auto bit = model_.holds(fluent, 0);
    add({std::move(on), std::move(off)}, first ? ~bit : bit, fluent);
  }
  void add_released(std::uint32_t fluent) {
    add({triggers(fluent, {EffectKind::kReleases}),
         triggers(fluent, {EffectKind::kInitiates, EffectKind::kTerminates})},
        model_.released(fluent, 0), fluent);
  }

  Triggers triggers(std::uint32_t fluent, std::initializer_list<EffectKind> kinds) {
    std::map<std::uint32_t, std::vector<FormulaId>> conditions;
    for (const auto* row : rows_of_[fluent]) {
      for (const auto kind : kinds) {
        if (row->kind == kind) conditions[row->event].push_back(row->condition);
      }
    }
    Triggers result;
    for (auto& [event, ways] : conditions) {
      result.emplace(event, model_.formulas().disjunction(std::move(ways)));
    }
    return result;
  }

  /// `bit` is false at 0.
  void add(Behaviour behaviour, FormulaId bit, std::uint32_t fluent) {
    if (behaviour.first.empty()) return;  // never true: nothing to learn from an equal
    const auto [known, is_new] = first_.emplace(std::move(behaviour), bit);
    if (is_new) return;
    const auto origin =
        model_.add_origin(model_.fluent_symbol(fluent).declared, OriginKind::kInvariant);
    auto& formulas = model_.formulas();
    model_.require_always(formulas.implication(bit, known->second), origin, 0);
    model_.require_always(formulas.implication(known->second, bit), origin, 0);
  }

  GroundModel& model_;
  std::vector<Truth> initial_;                          // by fluent, at 0
  std::vector<std::vector<const EffectRow*>> rows_of_;  // by fluent; empty: not looked at
  std::map<Behaviour, FormulaId> first_;
};

}  // namespace

void add_equal_bits(GroundModel& model, const EffectRows& rows) {
  if (model.horizon() > 0) EqualBits(model, rows).run();
}

}  // namespace parallax::compiler
