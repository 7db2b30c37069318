#pragma once

#include <span>
#include <string>
#include <variant>
#include <vector>

#include "compiler/builtins/plan_value.h"
#include "compiler/interpreter/plan_compiler.h"

namespace parallax::compiler {

/// One value for each parameter of the unit, in their order, from the values of a call that is
/// known only while the plan runs: `:key value` pairs find their parameters; an omitted parameter
/// gets its default, or the mark by which the unit computes it. A text is the error if the values
/// do not fit.
std::variant<std::vector<ValueId>, std::string> unit_arguments(const PlanUnit& unit,
                                                               std::span<const ValueId> given,
                                                               ValueStore& values);

}  // namespace parallax::compiler
