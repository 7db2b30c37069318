#pragma once

#include "compiler/artifact/compiled_model.h"

namespace parallax::runtime {

/// The same model with the plan's control as part of the state: its locations, what the last
/// perform came to and the objects that the plan knows, which are single variables of a timepoint
/// in what the compiler writes, become slots of every timepoint behind those of the state. Where
/// control cannot be they are false. What says where a trace may end (kHit, kRunning) is left out:
/// this is about traces that go on. Sections are left out as well.
compiler::CompiledModel with_plan_slots(const compiler::CompiledModel& model);

}  // namespace parallax::runtime
