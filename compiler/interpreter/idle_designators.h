#pragma once

#include "compiler/base/diagnostic.h"
#include "compiler/builtins/plan_value.h"
#include "compiler/interpreter/plan_compiler.h"
#include "compiler/lisp/lisp_reader.h"
#include "compiler/plan/plan_binding.h"

namespace parallax::compiler {

/// Warns of action and motion designators whose value nothing looks at (W-PERFORM), at their place:
/// the value is dropped, or is part of a list that is, or of a variable that nobody reads, or is
/// the result of a function whose calls all drop it. Such a designator does nothing; most likely
/// its `perform` is missing. What may be used in a way that the code does not show is not reported.
void warn_of_idle_designators(const LispText& text, const PlanCode& code,
                              const PlanBinding& binding, const ValueStore& values,
                              base::DiagnosticSink& sink);

}  // namespace parallax::compiler
