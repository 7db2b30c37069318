#pragma once

#include "compiler/interpreter/plan_compiler.h"

namespace parallax::compiler {

/// Notes as gaps: branches of a `par` that take turns and change what another one uses, in steps
/// between performs whose order is not explored; a loop across an array whose body may change
/// arrays. `ruled`: performs and goals may run any function of the plan.
void note_races(PlanCode& code, bool ruled);

}  // namespace parallax::compiler
