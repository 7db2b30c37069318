#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "compiler/formula/evaluate.h"
#include "compiler/ground/effect_rows.h"
#include "compiler/ground/ground_model.h"

namespace parallax::compiler {

/// Some fluents at timepoint 0 with their values, by fluent.
using StateFacts = std::map<std::uint32_t, bool>;

/// What the constraints that hold at every timepoint say of a step: preconditions of events, and
/// events that exclude one another. Only what stands there as a literal is found.
class StepFacts {
 public:
  /// `model` outlives the object. Linear in the constraints' formulas.
  explicit StepFacts(const GroundModel& model);

  /// Fluents whose values are known when the row's event happens and its condition holds.
  StateFacts of(const EffectRow& row) const;
  bool exclusive(std::uint32_t event, std::uint32_t other) const;
  /// Does the formula hold in every state with these facts?
  bool implied(FormulaId formula, const StateFacts& facts) const;

 private:
  void read(FormulaId formula);
  void read_clause(std::span<const FormulaId> negated_parts);
  void add_literals(FormulaId formula, StateFacts& facts) const;

  const GroundModel& model_;
  std::map<std::uint32_t, std::vector<FormulaId>> preconditions_;  // by event
  std::set<std::pair<std::uint32_t, std::uint32_t>> exclusive_;    // smaller event first
};

}  // namespace parallax::compiler
