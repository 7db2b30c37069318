#pragma once

#include <functional>
#include <set>
#include <string>

#include "compiler/interpreter/plan_compiler.h"

namespace parallax::compiler {

/// Notes in the code whether the plan tells designators apart, and whether it asks what they say.
/// All names of the text, but those in definitions of conditions.
std::set<std::string, std::less<>> note_designator_use(const LispText& text, PlanCode& code);

}  // namespace parallax::compiler
