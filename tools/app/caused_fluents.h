#pragma once

#include <functional>
#include <string>
#include <vector>

#include "compiler/sema/typed_model.h"
#include "harness/config/scenario.h"

namespace parallax::tools {

/// The ground fluents that ground events initiate and terminate by the model's effect axioms,
/// whatever the conditions. Only of events whose symbol `is_asked` accepts.
std::vector<harness::CausedFluent> caused_fluents(
    const compiler::TypedModel& model, const std::vector<harness::GroundFluent>& events,
    const std::vector<harness::GroundFluent>& fluents,
    const std::function<bool(const std::string&)>& is_asked);

}  // namespace parallax::tools
