#pragma once

#include <optional>
#include <vector>

#include "compiler/ground/formula_grounder.h"
#include "compiler/ground/ground_model.h"

namespace parallax::compiler {

/// Turns effect axioms into rows: once for all timepoints where the axiom says the same of each,
/// else timepoint by timepoint. Errors are the grounder's.
class EffectGrounder {
 public:
  EffectGrounder(GroundModel& model, FormulaGrounder& grounder, EffectRows& rows);
  /// From now on rows go there; it outlives the grounder or the next call.
  void write_to(EffectRows& rows) { rows_ = &rows; }
  /// Can the axiom's events happen at fixed timepoints only?
  bool is_scheduled(const EffectAxiom& effect) const;
  /// Every timepoint.
  void ground(const EffectAxiom& effect);
  /// The rows of timepoint t.
  void ground_at(const EffectAxiom& effect, Timepoint t);

 private:
  void run(const EffectAxiom& effect, bool always);
  void instance(const EffectAxiom& effect, bool always);
  bool is_ignored(std::uint32_t fluent) const;
  void find_lost(const EffectAxiom& effect);
  void check_lost(const EffectAxiom& effect, Timepoint t);
  std::uint32_t origin_of(const EffectAxiom& effect);

  GroundModel& model_;
  FormulaGrounder& grounder_;
  EffectRows* rows_;
  std::vector<std::uint32_t> origins_;  // by axiom
  std::optional<Timepoint> only_;       // no rows of other timepoints
};

/// Asserts DEC5 to DEC12 of Mueller 2006 over the rows. Initiates, Terminates and Releases never
/// become atoms: circumscription makes them the disjunction of their rows, so a fluent's frame
/// axioms mention only the events that can touch it.
void assert_inertia(GroundModel& model, const EffectRows& rows, const GroundOptions& options);

/// Asserts DEC3 and DEC4: the trajectory axioms, between the event that starts their fluent and the
/// first one that stops it. Quadratic in the horizon.
void assert_trajectories(GroundModel& model, const EffectRows& rows, FormulaGrounder& grounder,
                         base::DiagnosticSink& sink);

}  // namespace parallax::compiler
