#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "compiler/ground/ground_model.h"

namespace parallax::compiler {

/// `condition -> KIND(event, fluent, t)`, without variables.
struct EffectRow {
  EffectKind kind = EffectKind::kInitiates;
  std::uint32_t event = 0;
  std::uint32_t fluent = 0;
  FormulaId condition;
  std::uint32_t origin = 0;
};

/// The completed effect predicates: Initiates(e,f,t) holds iff some row of t for e and f has a
/// true condition. Rows are kept in order of axioms and instances: some hold at every timepoint
/// before the last, with a condition given for timepoint 0, the others at one timepoint.
class EffectRows {
 public:
  explicit EffectRows(std::size_t fluent_count) : by_fluent_(fluent_count) {}
  void add_always(const EffectRow& row);
  void add(Timepoint t, const EffectRow& row);
  /// Leaves out the rows that hold at every timepoint for which `keep` is false.
  template <typename Keep>
  void filter_always(const Keep& keep) {
    std::vector<EffectRow> kept;
    for (const auto& row : always_) {
      if (keep(row)) kept.push_back(row);
    }
    always_.clear();
    for (auto& numbers : by_fluent_) numbers.clear();
    for (const auto& row : kept) add_always(row);
  }

  const std::vector<EffectRow>& always() const { return always_; }
  const std::map<Timepoint, std::vector<EffectRow>>& single() const { return single_; }
  /// Do all rows of the fluent hold at every timepoint?
  bool is_uniform(std::uint32_t fluent) const { return !irregular_.contains(fluent); }

  /// Does an event change the fluent this way at t?
  FormulaId changed(EffectKind kind, std::uint32_t fluent, Timepoint t, GroundModel& model) const;
  /// The effect predicate as a formula: the disjunction of the conditions.
  FormulaId holds(EffectKind kind, std::uint32_t event, std::uint32_t fluent, Timepoint t,
                  GroundModel& model) const;

 private:
  std::vector<EffectRow> always_;
  std::vector<std::vector<std::uint32_t>> by_fluent_;  // into always_
  std::map<Timepoint, std::vector<EffectRow>> single_;
  std::map<std::pair<Timepoint, std::uint32_t>, std::vector<std::uint32_t>> single_by_fluent_;
  std::set<std::uint32_t> irregular_;
};

}  // namespace parallax::compiler
