#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "runtime/graph/layered_model.h"

namespace parallax::runtime {

/// Clauses of the axioms, or of the plan, for one step. A step begins in a phase: a timepoint at
/// first; where the clauses repeat from some timepoint on, the phases do too, so that there is a
/// next step after any number of steps.
struct StepPart {
  std::vector<WindowClauses> windows;    // each one once
  std::vector<std::uint32_t> window_of;  // by phase
  std::optional<std::uint32_t>
      comes_after;  // the phase behind the last one; none: nothing is known

  /// The next phase. Behind the last one, if nothing comes after it: one that does not exist.
  std::uint32_t next(std::uint32_t phase) const {
    return phase + 1 < window_of.size()
               ? phase + 1
               : comes_after.value_or(static_cast<std::uint32_t>(window_of.size()));
  }
  bool knows(std::uint32_t phase) const { return phase < window_of.size(); }
};

/// A model, with its plan if it has one, as the clauses of its single steps. Axioms and plan are
/// kept apart: a step may be one of the model alone, while the plan's control stands still. A step
/// that both take has the clauses of both.
struct StepWindows {
  compiler::CompiledModel model;  // with_plan_slots
  LayeredModel layered;           // of both together
  StepPart axioms, plan;          // without a plan, `plan` allows everything
  bool ends = false;              // no trace is longer than the phases of the axioms
  /// State slots of the plan's control, [first, last): none without a plan.
  std::uint32_t first_plan_slot = 0, last_plan_slot = 0;
  std::vector<std::uint32_t> outcomes;   // of the plan's slots: a perform succeeded
  std::vector<std::uint32_t> locations;  // of the plan's slots, by PlanStepId where known
  std::vector<std::uint32_t> cuts;       // of the plan's slots, by PlanCutId where known

  bool goes_on() const { return axioms.comes_after && plan.comes_after; }
  /// The clauses of a step that takes the axioms from one phase and the plan from another.
  WindowClauses joined(std::uint32_t axiom_phase, std::uint32_t plan_phase) const;
};

/// Steps beyond the horizon of a model.
enum class Beyond : std::uint8_t {
  kTheSame,  // windows that repeat before it go on; where none do, nothing is known
  kNothing,  // traces end there at the latest
};

/// Splits a model, or says why it has no steps: "the clauses of `...` look at more than two
/// neighbouring timepoints". The steps are those of every trace up to the model's horizon, and of
/// longer ones if the windows before the horizon repeat themselves; axioms about single timepoints
/// beyond it say nothing, as everywhere. Linear in the clauses.
std::variant<std::unique_ptr<StepWindows>, std::string> step_windows(
    const compiler::CompiledModel& model, Beyond beyond = Beyond::kTheSame);

}  // namespace parallax::runtime
