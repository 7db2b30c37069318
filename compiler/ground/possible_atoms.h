#pragma once

#include <map>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "compiler/ground/ground_model.h"
#include "compiler/ground/ground_table.h"

namespace parallax::compiler {

/// An upper bound of what can be true, known before grounding: joins run over these tables instead
/// of whole sorts. An atom outside the bound is false in every trace.
class PossibleAtoms {
 public:
  explicit PossibleAtoms(GroundModel& model);

  /// Fluents that may hold at some timepoint, by symbol.
  GroundTable& fluents(SymbolId symbol);
  /// Events that may happen, by symbol; with the timepoint as last column if `is_scheduled`.
  GroundTable& events(SymbolId symbol);
  /// User predicates that may be true; none where nothing is known.
  GroundTable* predicates(SymbolId symbol);

  /// Does every occurrence of the symbol's events stand at a fixed timepoint?
  bool is_scheduled(SymbolId event_symbol) const {
    return !timeless_ && scheduled_[event_symbol.index()];
  }
  /// While on, bounds are those of all timepoints together: for what is said of every timepoint.
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

  void set_predicate_table(SymbolId symbol, GroundTable table);
  /// May the user predicate's atom be true?
  bool may_be_true(SymbolId symbol, GroundTermId term) const;

 private:
  GroundModel& model_;
  std::map<SymbolId, GroundTable> fluents_, predicates_;
  std::map<std::pair<SymbolId, bool>, GroundTable> events_;  // by symbol and whether timed
  std::map<SymbolId, std::unordered_set<std::uint32_t>> true_predicates_;
  std::vector<bool> scheduled_;  // by symbol
  bool all_scheduled_ = false;
  bool timeless_ = false;
  std::vector<std::pair<std::uint32_t, Timepoint>> occurrences_;
  std::unordered_set<std::uint64_t> occurrence_set_;
  /// By fluent: what holds from a timepoint on, ascending.
  std::unordered_map<std::uint32_t, std::vector<std::pair<Timepoint, bool>>> tracked_;
};

}  // namespace parallax::compiler
