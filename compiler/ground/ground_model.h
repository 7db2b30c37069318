#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "compiler/base/word_table.h"
#include "compiler/formula/formula.h"
#include "compiler/ground/universe.h"

namespace parallax::compiler {

/// An atom before variables are numbered. `index`: the number of the fluent or event; the ground
/// term of a user predicate; else the place in the list of names.
struct GroundAtom {
  static constexpr Timepoint kUntimed = -1;
  AtomKind kind = AtomKind::kHoldsAt;
  std::uint32_t index = 0;
  Timepoint time = kUntimed;
  /// Happens at the last timepoint of all, which only the 2005 reasoner knows.
  bool last = false;
  /// The horizon from which on it exists: an event at t needs the step to t + 1.
  Timepoint needed_horizon() const {
    return (time == kUntimed ? 0 : time) + (kind == AtomKind::kHappens && !last ? 1 : 0);
  }
};

/// A propositional formula that holds, and the text that says so.
struct Constraint {
  static constexpr Timepoint kOnce = -1;
  FormulaId formula;
  std::uint32_t origin = 0;
  /// kOnce, or: the formula, whose earliest timepoint is 0, holds moved to every timepoint
  /// 0 .. horizon - width.
  Timepoint width = kOnce;
};

/// A sum of weights over formulas, each an atom, a negated one or true.
struct GroundObjective {
  struct Term {
    std::int64_t weight = 0;
    FormulaId formula;
    Timepoint needed = 0;  // the horizon from which on it counts
  };
  std::string text;
  std::vector<Term> terms;
};

/// By symbol: does the fluent need ReleasedAt atoms? It does if an axiom can release it, if it has
/// no inertia, if its release is left open, or if some axiom speaks of ReleasedAt (about a variable
/// fluent: all).
std::vector<bool> releasable_symbols(const TypedModel& model);

/// The model without variables: atoms, and the formulas that hold over them.
class GroundModel {
 public:
  GroundModel(const TypedModel& model, GroundTermStore terms, Universe universe);

  Timepoint horizon() const { return universe_.horizon(); }
  const TypedModel& typed() const { return *typed_; }
  GroundTermStore& terms() { return terms_; }
  const GroundTermStore& terms() const { return terms_; }
  const Universe& universe() const { return universe_; }
  FormulaStore& formulas() { return formulas_; }
  const FormulaStore& formulas() const { return formulas_; }

  const std::vector<GroundTermId>& fluents() const { return fluents_; }
  const std::vector<GroundTermId>& events() const { return events_; }
  std::optional<std::uint32_t> fluent_number(GroundTermId term) const;
  std::optional<std::uint32_t> event_number(GroundTermId term) const;
  const Symbol& fluent_symbol(std::uint32_t fluent) const {
    return typed_->symbols[terms_[fluents_[fluent]].symbol];
  }

  /// HoldsAt for 0 <= t <= horizon.
  FormulaId holds(std::uint32_t fluent, Timepoint t);
  /// Happens for 0 <= t < horizon: events at the last timepoint have no effect and do not exist.
  FormulaId happens(std::uint32_t event, Timepoint t);
  /// Happens at the last timepoint: to the 2005 reasoner an atom that nothing follows from.
  FormulaId happens_last(std::uint32_t event);
  /// The same if some formula has mentioned it.
  std::optional<FormulaId> find_happens_last(std::uint32_t event);
  /// False for fluents that nothing ever releases.
  FormulaId released(std::uint32_t fluent, Timepoint t);
  bool can_be_released(std::uint32_t fluent) const { return releasable_[fluent]; }
  /// A user predicate over ground arguments, as a ground term.
  FormulaId predicate(GroundTermId term);
  /// From now on the atom is written as truth. A constraint says that it is true.
  void note_true_predicate(GroundTermId term) { true_predicates_.insert(term); }
  /// From now on atoms of the predicate that no formula has mentioned yet are false.
  void close_predicate(SymbolId predicate) { closed_.insert(predicate); }
  /// The variable of a user predicate's atom, if some formula has mentioned it.
  std::optional<std::int32_t> find_predicate(GroundTermId term) const {
    const auto found = predicates_.find(term);
    if (found == predicates_.end()) return std::nullopt;
    return found->second;
  }
  /// An atom that is made when first asked for.
  FormulaId plan_atom(AtomKind kind, PlanAtom plan, Timepoint t);
  /// A new atom without a meaning of its own, of the horizon `time`.
  FormulaId auxiliary_atom(Timepoint time);

  /// SAT variables of the formula store, in order of first mention.
  const GroundAtom& atom(std::int32_t variable) const {
    return atoms_[static_cast<std::size_t>(variable) - 1];
  }
  std::size_t atom_count() const { return atoms_.size(); }
  std::string atom_name(const GroundAtom& atom) const;
  /// The atom as the compiled model describes it.
  Atom described(const GroundAtom& atom) const;
  /// The formula with every timepoint moved by `steps`.
  FormulaId shifted(FormulaId formula, Timepoint steps);

  /// False at every timepoint: no formula need mention it, no variable is made for it.
  void never_holds(std::uint32_t fluent) { may_hold_[fluent] = false; }
  void can_hold(std::uint32_t fluent) { may_hold_[fluent] = true; }
  void never_happens(std::uint32_t event) { may_happen_[event] = false; }
  bool may_hold(std::uint32_t fluent) const { return may_hold_[fluent]; }
  bool may_happen(std::uint32_t event) const { return may_happen_[event]; }

  std::uint32_t add_origin(base::SourceRange source, OriginKind kind);
  void require(FormulaId formula, std::uint32_t origin);
  /// Requires the formula, whose earliest timepoint is 0, at every timepoint 0 .. horizon - width.
  void require_always(FormulaId formula, std::uint32_t origin, Timepoint width);

  /// The horizon from which on every atom of the formula exists.
  Timepoint needed_horizon_of(FormulaId formula) const;

  /// Notes that the grounder looked at this many instances of a text.
  void charge(base::SourceRange source, std::int64_t instances) {
    charges_.emplace_back(source, instances);
  }
  /// In the order of grounding; a text may have several entries.
  const std::vector<std::pair<base::SourceRange, std::int64_t>>& charges() const {
    return charges_;
  }

  void add_objective(GroundObjective objective) { objectives_.push_back(std::move(objective)); }
  const std::vector<GroundObjective>& objectives() const { return objectives_; }

  const std::vector<Constraint>& constraints() const { return constraints_; }
  /// Says the same in another way.
  void reword(std::size_t constraint, FormulaId formula) {
    constraints_[constraint].formula = formula;
  }
  const std::vector<Origin>& origins() const { return origins_; }

 private:
  static std::uint64_t timed_key(AtomKind kind, std::uint32_t index, Timepoint t);
  FormulaId timed(AtomKind kind, std::uint32_t index, Timepoint t);

  const TypedModel* typed_;  // outlives the ground model
  GroundTermStore terms_;
  Universe universe_;
  FormulaStore formulas_;
  std::vector<GroundTermId> fluents_, events_;
  std::unordered_map<GroundTermId, std::uint32_t> fluent_numbers_, event_numbers_;
  std::vector<bool> releasable_;             // by fluent
  std::vector<bool> may_hold_, may_happen_;  // by fluent, by event
  std::vector<GroundAtom> atoms_;            // by variable - 1
  std::unordered_map<std::uint64_t, std::int32_t> timed_;
  std::unordered_map<GroundTermId, std::int32_t> predicates_;
  std::set<SymbolId> closed_;
  std::unordered_set<GroundTermId> true_predicates_;
  std::map<std::tuple<AtomKind, PlanAtom, Timepoint>, std::int32_t> plan_variables_;
  std::vector<PlanAtom> plan_atoms_;
  std::vector<Constraint> constraints_;
  std::vector<GroundObjective> objectives_;
  std::vector<Origin> origins_;
  std::vector<std::pair<base::SourceRange, std::int64_t>> charges_;
};

/// `condition -> KIND(event, fluent, t)`, without variables.
struct EffectRow {
  EffectKind kind = EffectKind::kInitiates;
  std::uint32_t event = 0;
  std::uint32_t fluent = 0;
  FormulaId condition;
  std::uint32_t origin = 0;
};

/// `Initiates(event, fluent, t)` without variables.
struct EffectKey {
  EffectKind kind = EffectKind::kInitiates;
  std::uint32_t event = 0;
  std::uint32_t fluent = 0;
  Timepoint time = 0;
  friend auto operator<=>(const EffectKey&, const EffectKey&) = default;
};

inline constexpr auto kEffectWords =
    base::word_table<EffectKind>("Initiates", "Terminates", "Releases");
constexpr std::string_view effect_word(EffectKind kind) { return kEffectWords.of(kind); }

/// The completed effect predicates: Initiates(e,f,t) holds iff some row of t for e and f has a
/// true condition. Rows are kept in order of axioms and instances: some hold at every timepoint
/// before the last, with a condition given for timepoint 0, the others at one timepoint.
class EffectRows {
 public:
  explicit EffectRows(std::size_t fluent_count) : by_fluent_(fluent_count) {}
  void add_always(const EffectRow& row);
  void add(Timepoint t, const EffectRow& row);
  /// Takes these rows for those that hold at every timepoint.
  void replace_always(const std::vector<EffectRow>& rows) {
    always_.clear();
    for (auto& numbers : by_fluent_) numbers.clear();
    for (const auto& row : rows) add_always(row);
  }
  /// Leaves out the rows that hold at every timepoint for which `keep` is false.
  template <typename Keep>
  void filter_always(const Keep& keep) {
    std::vector<EffectRow> kept;
    for (const auto& row : always_) {
      if (keep(row)) kept.push_back(row);
    }
    replace_always(kept);
  }

  const std::vector<EffectRow>& always() const { return always_; }
  const std::map<Timepoint, std::vector<EffectRow>>& single() const { return single_; }
  /// To the 2005 reasoner an axiom of this kind names something at t that does not exist: what else
  /// could change the fluent at t is lost with it.
  void lose(EffectKind kind, std::uint32_t fluent, Timepoint t) { lost_.emplace(kind, fluent, t); }
  bool is_lost(EffectKind kind, std::uint32_t fluent, Timepoint t) const {
    return lost_.contains({kind, fluent, t});
  }
  /// Do all rows of the fluent hold at every timepoint?
  bool is_uniform(std::uint32_t fluent) const { return !irregular_.contains(fluent); }

  /// Does an event change the fluent this way at t?
  FormulaId changed(EffectKind kind, std::uint32_t fluent, Timepoint t, GroundModel& model) const;
  /// The same, where `given` (an atom, or a negated one) is known to be true.
  FormulaId changed(EffectKind kind, std::uint32_t fluent, Timepoint t, FormulaId given,
                    GroundModel& model) const;
  /// The effect predicate as a formula: the disjunction of the conditions.
  FormulaId holds(EffectKind kind, std::uint32_t event, std::uint32_t fluent, Timepoint t,
                  GroundModel& model) const;

 private:
  std::vector<EffectRow> always_;
  std::vector<std::vector<std::uint32_t>> by_fluent_;  // into always_
  std::map<Timepoint, std::vector<EffectRow>> single_;
  std::map<std::pair<Timepoint, std::uint32_t>, std::vector<std::uint32_t>> single_by_fluent_;
  std::set<std::uint32_t> irregular_;
  std::set<std::tuple<EffectKind, std::uint32_t, Timepoint>> lost_;
};

/// `HoldsAt(Alive(),0)`; `aux7` for an atom without a name, by its variable.
std::string atom_text(const GroundModel& model, std::int32_t variable);

/// Prints the model's formulas. `model` outlives it.
FormulaText formula_text(const GroundModel& model);

/// `m.e:5 axiom`; without files, or without a place, `axiom`.
std::string origin_text(const Origin& origin, const base::SourceFiles* files);

/// `m.e:5 axiom: HoldsAt(F(),0) | ...` a line for each constraint, in order; those that hold at
/// every timepoint as they stand at 0, with ` (every timepoint, width 1)`. Then the parts.
std::string constraint_lines(const GroundModel& model, std::span<const Constraint> constraints,
                             FormulaText& formulas, const base::SourceFiles* files);

/// All that grounding knows so far, for people: which fluents and events are left out, the effect
/// rows, the constraints. Deterministic; linear in the model.
std::string ground_text(const GroundModel& model, const EffectRows& rows,
                        const base::SourceFiles* files);

}  // namespace parallax::compiler
