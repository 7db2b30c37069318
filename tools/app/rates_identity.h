#pragma once

#include "harness/campaign/rates.h"
#include "harness/config/scenario_settings.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {

/// Says in the result which texts it is of, and by hashes of the scenario's settings where its
/// simulations begin and how they are judged, so that one who compares it with another sees whether
/// both are about the same.
void add_identity(const ScenarioModel& loaded, const harness::ScenarioSettings& settings,
                  harness::RatesResult& result);

}  // namespace parallax::tools
