#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "compiler/formula/formula.h"
#include "compiler/ground/completion.h"
#include "compiler/ground/ground_model.h"
#include "compiler/ground/meetings.h"
#include "compiler/ground/universe.h"

namespace parallax::compiler {

/// The atoms of one symbol that may be true, as rows of values: the arguments and, in tables of
/// event occurrences, the timepoint last. Grows at the end; rows keep their numbers.
class GroundTable {
 public:
  explicit GroundTable(std::size_t columns) : columns_(columns) {}
  void add(std::span<const GroundTermId> row);
  std::size_t size() const { return rows_; }
  std::size_t columns() const { return columns_; }
  std::span<const GroundTermId> row(std::uint32_t number) const {
    return std::span(values_).subspan(number * columns_, columns_);
  }
  /// The rows whose columns in `mask` (bit i: column i) hold `key`, in order. An index on the mask
  /// is built when first asked for. Valid until the next `add`.
  std::span<const std::uint32_t> find(std::uint64_t mask, std::span<const GroundTermId> key);

 private:
  using Index = std::unordered_map<std::uint64_t, std::vector<std::uint32_t>>;  // by hash of key
  static std::uint64_t hash(std::span<const GroundTermId> key);
  void note(Index& index, std::uint64_t mask, std::uint32_t number) const;

  std::size_t columns_;
  std::size_t rows_ = 0;
  std::vector<GroundTermId> values_;
  std::map<std::uint64_t, Index> indexes_;  // by mask
};

/// An upper bound on the atoms that can be true, known before grounding: joins run over these
/// tables instead of whole sorts. An atom outside the bound is false in every trace.
class PossibleAtoms {
 public:
  explicit PossibleAtoms(GroundModel& model);

  /// Fluents that may hold at some timepoint, by symbol.
  GroundTable& fluents(SymbolId symbol);
  /// Events that may happen, by symbol; with the timepoint as last column if `is_scheduled`.
  GroundTable& events(SymbolId symbol);
  /// User predicates that may be true, and (without their timepoint) effects that there may be;
  /// none where nothing is known.
  GroundTable* predicates(SymbolId symbol);

  /// Does every occurrence of the symbol's events stand at a fixed timepoint?
  bool is_scheduled(SymbolId event_symbol) const {
    return !timeless_ && scheduled_[event_symbol.index()];
  }
  /// While on, bounds are those of all timepoints together: for formulas about every timepoint.
  void set_timeless(bool timeless) { timeless_ = timeless; }
  bool all_events_scheduled() const { return all_scheduled_; }
  /// The events of the symbols happen at most at these timepoints. Call once, before any table.
  void schedule(const std::vector<bool>& symbols,
                const std::vector<std::pair<std::uint32_t, Timepoint>>& occurrences);
  const std::vector<std::pair<std::uint32_t, Timepoint>>& occurrences() const {
    return occurrences_;
  }

  /// From timepoint `from` on, until the next call for this fluent (with a later timepoint), the
  /// fluent may hold or does not.
  void track(std::uint32_t fluent, Timepoint from, bool may_hold);
  /// The fluent, left out before, may hold after all.
  void admit(std::uint32_t fluent);
  /// Fluents have been left out: tables are made anew.
  void forget_fluent_tables() { fluents_.clear(); }
  bool may_hold(std::uint32_t fluent, std::optional<Timepoint> t) const;
  bool may_happen(std::uint32_t event, std::optional<Timepoint> t) const;

  /// From now on instances in which an event and a fluent meet that cannot are left out.
  void know_meetings(Meetings meetings) { meetings_ = std::move(meetings); }
  bool knows_meetings() const { return !meetings_.empty(); }
  bool may_meet(std::uint32_t event, std::uint32_t fluent) const {
    return meetings_.may_meet(event, fluent);
  }
  const Meetings& meetings() const { return meetings_; }

  /// From now on there are tables of effects, at first empty.
  void know_effects();
  /// False: it was there.
  bool add_effect(EffectKind kind, std::uint32_t event, std::uint32_t fluent);

  void set_predicate_table(SymbolId symbol, GroundTable table);
  /// May the user predicate's atom be true?
  bool may_be_true(SymbolId symbol, GroundTermId term) const;

 private:
  /// Numbers of ground terms by their symbol, made anew when there are more terms.
  struct BySymbol {
    std::size_t terms = 0;
    std::vector<std::vector<std::uint32_t>> numbers;
  };
  const std::vector<std::uint32_t>& numbers_of(SymbolId symbol,
                                               const std::vector<GroundTermId>& terms,
                                               BySymbol& index) const;

  GroundModel& model_;
  BySymbol fluent_numbers_, event_numbers_;
  std::map<SymbolId, GroundTable> fluents_, predicates_;
  std::map<std::pair<SymbolId, bool>, GroundTable> events_;  // by symbol and whether timed
  std::map<SymbolId, std::unordered_set<std::uint32_t>> true_predicates_;
  std::set<std::tuple<EffectKind, std::uint32_t, std::uint32_t>> effects_;
  Meetings meetings_;
  std::vector<bool> scheduled_;  // by symbol
  bool all_scheduled_ = false;
  bool timeless_ = false;
  std::vector<std::pair<std::uint32_t, Timepoint>> occurrences_;
  std::unordered_set<std::uint64_t> occurrence_set_;
  /// By fluent: its value from a timepoint on, ascending.
  std::unordered_map<std::uint32_t, std::vector<std::pair<Timepoint, bool>>> tracked_;
};

/// Values of HoldsAt(fluent, 0) that the constraints so far state outright, by fluent.
std::vector<Truth> initial_values(const GroundModel& model);

/// Fluents that are always false are left out of large models only, with more HoldsAt atoms than
/// `keep`: in a small one they cost nothing, and an unsatisfiable core can then name every axiom
/// that takes part.
bool is_worth_leaving_out(const GroundModel& model, std::size_t keep);

/// Leaves out fluents that are false at first and that no row can ever make true, and the rows that
/// need them: a fixpoint over the rows, linear in their number for every round.
void drop_unreachable(GroundModel& model, PossibleAtoms& possible, EffectRows& rows,
                      std::size_t keep);

/// Makes tables of the user predicates that the constraints so far settle, wholly or in part: an
/// atom is left out if unit propagation, or the completion of its predicate, makes it false.
/// A predicate that axioms about time speak of is completed later, and gets no table by completion.
/// Predicates over more than 200,000 argument tuples get no table.
/// `fold`: from now on atoms that are true in every trace are written as truth, if nothing
/// completes their predicate.
void tabulate_predicates(GroundModel& model, const CompletionWriter& completion, bool fold,
                         PossibleAtoms& possible);

}  // namespace parallax::compiler
