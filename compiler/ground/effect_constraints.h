#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "compiler/ground/effects.h"
#include "compiler/ground/least_fixpoint.h"
#include "compiler/ground/possible_atoms.h"

namespace parallax::compiler {

/// Effect axioms whose conditions mention effects (Mueller 2006,
/// section 6.4.1): the effect predicates are the least ones that all effect
/// axioms admit (circumscription). While the axioms are grounded, an effect in
/// a condition is an atom that stands for it; then the least solution takes the
/// place of these atoms, so that rows are rows as all others.
class EffectConstraints {
 public:
  /// `possible` may be null: then conditions are not joined with the effects
  /// that there may be.
  EffectConstraints(GroundModel& model, FormulaGrounder& grounder, EffectGrounder& effects,
                    EffectRows& rows, PossibleAtoms* possible, base::DiagnosticSink& sink);
  /// Adds the rows of the axioms; `rows` has those of all other effect axioms.
  /// Reports a cycle through a negation (kEffectCycle).
  void ground(const std::vector<const EffectAxiom*>& axioms);

 private:
  struct Pending {
    Timepoint time = 0;
    EffectRow row;
  };
  FormulaId atom(const EffectKey& key);
  /// Notes which events can change which fluents how; true if that was not all
  /// known.
  bool note_possible(const EffectRows& rows);
  bool note_possible(const EffectRow& row);
  bool is_uniform(const EffectRows& found) const;
  void expand(const EffectRows& found);
  FormulaId moved(FormulaId condition, Timepoint steps);
  FixpointSystem system();
  void write(const std::vector<FormulaId>& solution);
  void report(const FixpointCycle& cycle) const;
  std::string text(const EffectKey& key) const;
  /// The axiom by which the effect needs the other.
  base::SourceRange source_of(const EffectKey& key, std::size_t needed, bool negated) const;

  GroundModel& model_;
  FormulaGrounder& grounder_;
  EffectGrounder& effects_;
  EffectRows& rows_;
  PossibleAtoms* possible_;
  base::DiagnosticSink& sink_;
  bool uniform_ = false;  // every row holds at every timepoint; conditions are those of 0
  std::map<EffectKey, std::size_t> numbers_;
  std::vector<EffectKey> keys_;                                       // by number
  std::unordered_map<std::int32_t, std::size_t> number_of_variable_;  // look-up only
  std::vector<Pending> pending_;
  std::map<EffectKey, std::vector<std::size_t>> pending_by_key_;
};

}  // namespace parallax::compiler
