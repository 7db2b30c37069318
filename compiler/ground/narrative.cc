// Bounds from events at known timepoints, by a walk forward in time.
//
// If Happens is completed and all axioms that can give a symbol's events a reason speak of fixed
// timepoints, the events of the symbol are scheduled: they happen at these occurrences at most.
// Fluents that have inertia, are known at 0 and are changed by scheduled events alone are then
// followed. At each occurrence the effect axioms are grounded for this timepoint only, their
// conditions are evaluated in three values, and a fluent afterwards holds, does not hold, or may
// do either: it may hold if something may begin it, or it may have held and nothing must have
// ended it. So the bounds contain every trace, and joins see what may hold when.
//
// Cost: one grounding of the scheduled effects for each timepoint with an occurrence, linear in
// the rows found.

#include "compiler/ground/narrative.h"

#include <algorithm>
#include <map>
#include <utility>

#include "compiler/ground/possible_atoms.h"
#include "compiler/ground/time_profile.h"
#include "compiler/sema/axiom_shapes.h"

namespace parallax::compiler {
namespace {

/// Calls visit(event term) for every occurrence of Happens in the formula that is not negative.
template <typename Visit>
void for_each_positive_event(const TypedModel& model, TypedFormulaId root, const Visit& visit) {
  struct SignedPart {
    TypedFormulaId id;
    bool positive, negative;
  };
  std::vector<SignedPart> todo = {{root, true, false}};
  while (!todo.empty()) {
    const auto part = todo.back();
    todo.pop_back();
    const auto& formula = model.formulas[part.id];
    if (formula.kind == FormulaKind::kAtom) {
      if (part.positive && formula.predicate == model.core.happens) visit(formula.terms[0]);
      continue;
    }
    for (std::size_t i = 0; i < formula.children.size(); ++i) {
      SignedPart child{formula.children[i], part.positive, part.negative};
      const bool flips =
          formula.kind == FormulaKind::kNot || (formula.kind == FormulaKind::kImplies && i == 0);
      if (flips) std::swap(child.positive, child.negative);
      if (formula.mixes_polarity()) child.positive = child.negative = true;
      todo.push_back(child);
    }
  }
}

bool is_same_time(const TypedModel& model, TermId a, TermId b) {
  const auto &left = model.terms[a], &right = model.terms[b];
  return a == b || (left.kind == TermKind::kVariable && right.kind == TermKind::kVariable &&
                    left.variable == right.variable);
}

/// Calls visit(fluent term) for every HoldsAt of the effect's condition at another timepoint than
/// the event's.
template <typename Visit>
void for_each_other_time(const TypedModel& model, const EffectAxiom& effect, const Visit& visit) {
  std::vector<TypedFormulaId> todo = {effect.condition};
  while (!todo.empty()) {
    const auto& formula = model.formulas[todo.back()];
    todo.pop_back();
    if (formula.kind == FormulaKind::kAtom && formula.predicate == model.core.holds_at &&
        !is_same_time(model, formula.terms[1], effect.time)) {
      visit(formula.terms[0]);
    }
    todo.insert(todo.end(), formula.children.begin(), formula.children.end());
  }
}

struct Change {
  bool may_begin = false, must_begin = false, may_cease = false, must_cease = false;
  void add(bool begins, bool certain) {
    (begins ? may_begin : may_cease) = true;
    if (certain) (begins ? must_begin : must_cease) = true;
  }
};

}  // namespace

Narrative::Narrative(GroundModel& model, PossibleAtoms& possible, EffectRows& rows,
                     EffectGrounder& effects, std::size_t keep_unreachable)
    : model_(model),
      possible_(possible),
      rows_(rows),
      effects_(effects),
      keep_unreachable_(keep_unreachable) {}

/// An event symbol is scheduled if no axiom of the label with a time variable speaks of it
/// positively.
std::vector<bool> Narrative::scheduled_symbols(const Completion& completion) const {
  const auto& typed = model_.typed();
  std::vector<bool> scheduled(typed.symbols.size(), false);
  for (std::size_t i = 0; i < typed.symbols.size(); ++i) {
    scheduled[i] = typed.symbols[typed.symbols.id_at(i)].kind == SymbolKind::kEvent;
  }
  for (const auto& axiom : typed.axioms) {
    if (defines_by_effects(typed, axiom) || (completion.label && *completion.label != axiom.label))
      continue;
    const auto shape = time_profile(typed, axiom.formula).shape;
    if (shape == TimeShape::kRigid || shape == TimeShape::kFixed) continue;
    for_each_positive_event(typed, axiom.formula, [&](TermId event) {
      const auto& term = typed.terms[event];
      if (term.kind == TermKind::kApply) {
        scheduled[term.symbol.index()] = false;
      } else {
        scheduled.assign(scheduled.size(), false);
      }
    });
  }
  return scheduled;
}

void Narrative::schedule(const CompletionWriter& completion) {
  const auto& happens = model_.typed().core.happens;
  const auto* completed = happens ? completion.completion_of(*happens) : nullptr;
  if (completed == nullptr) return;
  const auto symbols = scheduled_symbols(*completed);
  std::vector<std::pair<std::uint32_t, Timepoint>> pairs;
  for (const auto& occurrence : completion.occurrences()) {
    const auto symbol = model_.terms()[model_.events()[occurrence.event]].symbol;
    if (!symbols[symbol.index()]) continue;
    occurrences_[{occurrence.time, occurrence.event}] = occurrence.certain;
    pairs.emplace_back(occurrence.event, occurrence.time);
  }
  possible_.schedule(symbols, pairs);
}

/// A fluent is followed if it has inertia throughout, a known value at first, only scheduled events
/// change it, and no effect depends on its value at another timepoint than the event's: the walk
/// grounds an effect before it knows what holds later.
void Narrative::choose_tracked() {
  const auto& typed = model_.typed();
  std::vector<bool> left_out(typed.symbols.size(), false);
  const auto leave_out = [&](TermId id) {
    const auto& fluent = typed.terms[id];
    if (fluent.kind == TermKind::kApply) {
      left_out[fluent.symbol.index()] = true;
    } else {
      left_out.assign(left_out.size(), true);
    }
  };
  for (const auto& effect : typed.effects) {
    if (!effects_.is_scheduled(effect)) leave_out(effect.fluent);
    for_each_other_time(typed, effect, leave_out);
  }
  tracked_.assign(model_.fluents().size(), false);
  for (std::uint32_t f = 0; f < model_.fluents().size(); ++f) {
    const auto symbol = model_.terms()[model_.fluents()[f]].symbol;
    tracked_[f] =
        !left_out[symbol.index()] && !model_.can_be_released(f) && values_[f] != Truth::kUnknown;
    if (!tracked_[f]) continue;
    if (values_[f] == Truth::kFalse && is_worth_leaving_out(model_, keep_unreachable_))
      model_.never_holds(f);
    possible_.track(f, 0, values_[f] == Truth::kTrue);
  }
}

void Narrative::walk() {
  values_ = initial_values(model_);
  choose_tracked();
  std::vector<Timepoint> times;
  for (const auto& [key, certain] : occurrences_) times.push_back(key.first);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  for (const auto t : times) {
    for (const auto& effect : model_.typed().effects) {
      if (effects_.is_scheduled(effect)) effects_.ground_at(effect, t);
    }
    apply(t);
  }
}

/// Applies the effect rows of t to the tracked fluents.
void Narrative::apply(Timepoint t) {
  const auto rows = rows_.single().find(t);
  if (rows == rows_.single().end()) return;
  const auto& formulas = model_.formulas();
  const auto atom_value = [&](std::int32_t variable) {
    const auto& atom = model_.atom(variable);
    const bool known = atom.kind == AtomKind::kHoldsAt && atom.time == t && tracked_[atom.index];
    return known ? values_[atom.index] : Truth::kUnknown;
  };
  std::map<std::uint32_t, Change> changes;
  for (const auto& row : rows->second) {
    if (row.kind == EffectKind::kReleases || !tracked_[row.fluent]) continue;
    const auto condition = evaluate(formulas, row.condition, atom_value);
    if (condition == Truth::kFalse) continue;
    const auto occurrence = occurrences_.find({t, row.event});
    const bool certain = occurrence != occurrences_.end() && occurrence->second;
    changes[row.fluent].add(row.kind == EffectKind::kInitiates,
                            certain && condition == Truth::kTrue);
  }
  for (const auto& [fluent, change] : changes) {
    const auto before = values_[fluent];
    const bool may_hold = change.may_begin || (before != Truth::kFalse && !change.must_cease);
    const bool may_fail = change.may_cease || (before != Truth::kTrue && !change.must_begin);
    const auto known = may_hold ? Truth::kTrue : Truth::kFalse;
    update(fluent, may_hold == may_fail ? Truth::kUnknown : known, t + 1);
  }
}

void Narrative::update(std::uint32_t fluent, Truth value, Timepoint t) {
  values_[fluent] = value;
  const bool may_hold = value != Truth::kFalse;
  possible_.track(fluent, t, may_hold);
  if (may_hold && !model_.may_hold(fluent)) possible_.admit(fluent);
}

}  // namespace parallax::compiler
