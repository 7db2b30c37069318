#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "compiler/formula/formula.h"
#include "compiler/ground/completion.h"
#include "compiler/ground/effects.h"

namespace parallax::compiler {

/// Bounds from a completed narrative, settled before anything else is grounded: which events can
/// happen when and, walking forward from the initial state, which fluents can hold when. Its effect
/// rows are made on the way, for the occurrences only.
class Narrative {
 public:
  /// `keep_unreachable`: as in GroundOptions.
  Narrative(GroundModel& model, PossibleAtoms& possible, EffectRows& rows, EffectGrounder& effects,
            std::size_t keep_unreachable);
  /// Reads the occurrences off the axioms noted so far: every axiom whose timepoints are all fixed.
  /// Events that other axioms of the label can bring about are not scheduled.
  void schedule(const CompletionWriter& completion);
  /// Grounds the effects of scheduled events, and bounds the fluents that only they change. Call
  /// once the constraints on timepoint 0 are there.
  void walk();

 private:
  std::vector<bool> scheduled_symbols(const Completion& completion) const;
  void choose_tracked();
  void apply(Timepoint t);
  void update(std::uint32_t fluent, Truth value, Timepoint t);

  GroundModel& model_;
  PossibleAtoms& possible_;
  EffectRows& rows_;
  EffectGrounder& effects_;
  std::size_t keep_unreachable_;
  std::map<std::pair<Timepoint, std::uint32_t>, bool> occurrences_;  // certain?
  std::vector<bool> tracked_;                                        // by fluent
  std::vector<Truth> values_;  // by fluent, at the timepoint reached
};

}  // namespace parallax::compiler
