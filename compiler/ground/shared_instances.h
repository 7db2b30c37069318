#pragma once

#include "compiler/base/diagnostic.h"
#include "compiler/ground/formula_grounder.h"

namespace parallax::compiler {

/// Warns of parts of a formula that are not said because a conjunct beside them names something
/// that does not exist (W3004), with an instance in which that is so. Once for each such conjunct.
/// `grounder` knows the effects.
void report_shared_instances(GroundModel& model, FormulaGrounder& grounder,
                             base::DiagnosticSink& sink);

}  // namespace parallax::compiler
