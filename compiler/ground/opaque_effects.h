#pragma once

#include <cstdint>
#include <map>
#include <unordered_map>

#include "compiler/ground/ground_model.h"

namespace parallax::compiler {

/// Atoms that stand for Initiates, Terminates and Releases while the reasons that an axiom with
/// such atoms gives are computed. The effect predicates have their own circumscription: a completed
/// atom in the condition of an effect is no part of the axiom (Mueller 2006, section 2.7).
class OpaqueEffects {
 public:
  /// Both outlive the object; `rows` is complete.
  OpaqueEffects(GroundModel& model, const EffectRows& rows) : model_(model), rows_(rows) {}
  /// The atom that stands for the effect; true or false where the rows leave nothing open.
  FormulaId atom(const EffectKey& effect);
  /// The formula with these atoms replaced by the conditions of the rows.
  FormulaId resolved(FormulaId formula) const;

 private:
  GroundModel& model_;
  const EffectRows& rows_;
  std::map<EffectKey, FormulaId> atoms_;
  std::unordered_map<std::int32_t, FormulaId> meaning_;  // by variable
};

}  // namespace parallax::compiler
