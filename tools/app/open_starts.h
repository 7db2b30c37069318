#pragma once

#include "tools/app/scenario_model.h"

namespace parallax::tools {

/// Warns of fluents that the model leaves open at timepoint 0 and that no start decides: the
/// mapping ignores them, and two initial states differ in them alone. The simulated world then
/// begins in the same way for both initial states.
void report_open_starts(const ScenarioModel& loaded, Context& context);

}  // namespace parallax::tools
