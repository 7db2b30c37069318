#pragma once

#include <optional>
#include <string>

#include "compiler/base/diagnostic.h"
#include "compiler/base/result.h"
#include "compiler/plan/lisp_reader.h"
#include "compiler/plan/plan_code.h"
#include "compiler/plan/plan_value.h"

namespace parallax::compiler {

/// Turns a plan into code for the unroller's machine. `entry` names the function to run; without it
/// the bare top-level forms run, or else the last function defined; CPL006 if there is nothing to
/// run. `interleave`: the branches of `par` take turns; otherwise they run in written order
/// (W-PAR).
base::Result<PlanCode> compile_plan(const LispText& text, const std::optional<std::string>& entry,
                                    bool interleave, ValueStore& values,
                                    base::DiagnosticSink& sink);

}  // namespace parallax::compiler
