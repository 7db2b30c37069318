#pragma once

#include <memory>

#include "compiler/base/result.h"
#include "harness/config/scenario.h"
#include "harness/discrete/stepped_model.h"
#include "tools/app/context.h"

namespace parallax::tools {

/// Compiles the model that is the scenario's world and cuts it into steps. Reports what compiling
/// reports, and kWorldNotPlayable: it completes `Happens`, it has no initial state or no execution
/// of the scenario's length, or its axioms look at more than two neighbouring timepoints.
base::Result<std::shared_ptr<const harness::SteppedModel>> load_world_model(
    const harness::Scenario& scenario, Context& context);

}  // namespace parallax::tools
