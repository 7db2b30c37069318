#pragma once

#include "compiler/artifact/compiled_model.h"

namespace parallax::runtime {

/// The same model with the plan's control as part of the state: its locations, the outcome of the
/// last perform and the objects that the plan knows, which are single variables of a timepoint in
/// the compiler's output, become slots of every timepoint behind those of the state. Where control
/// cannot be they are false. Atoms about where a trace may end (kHit, kRunning) are left out, since
/// the traces here go on. Sections are left out as well.
compiler::CompiledModel with_plan_slots(const compiler::CompiledModel& model);

}  // namespace parallax::runtime
