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

/// A model, with its plan if it has one, as what one step can do. A step begins in a phase: a
/// timepoint at first, and where the axioms (and the places that the plan's control can be at)
/// repeat themselves from some timepoint on, the phases do, so that there is a next step however
/// many there were.
struct StepWindows {
  compiler::CompiledModel model;  // with_plan_slots
  LayeredModel layered;
  std::vector<std::uint32_t> window_of;  // by phase: index into layered.steps
  std::optional<std::uint32_t>
      comes_after;                       // the phase behind the last one; none: nothing is known
  bool ends = false;                     // no trace is longer than the phases
  std::vector<std::uint32_t> outcomes;   // state slots: that a perform succeeded
  std::vector<std::uint32_t> locations;  // state slots of plan steps, by PlanStepId where known

  std::optional<std::uint32_t> next(std::uint32_t phase) const {
    if (phase + 1 < window_of.size()) return phase + 1;
    return comes_after;
  }
};

/// What there is behind the horizon of a model.
enum class Beyond : std::uint8_t {
  kTheSame,  // what repeats itself before it goes on; where nothing does, nothing is known
  kNothing,  // traces end there at the latest
};

/// Splits a model, or says why it has no steps: "the clauses of `...` look at more than two
/// neighbouring timepoints". The steps are those of every trace up to the model's horizon, and of
/// longer ones where the windows before the horizon repeat themselves: axioms about single
/// timepoints beyond it say nothing, as everywhere. Linear in the clauses.
std::variant<std::unique_ptr<StepWindows>, std::string> step_windows(
    const compiler::CompiledModel& model, Beyond beyond = Beyond::kTheSame);

}  // namespace parallax::runtime
