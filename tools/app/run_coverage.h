#pragma once

#include <vector>

#include "harness/campaign/campaign_result.h"
#include "tools/app/context.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {

/// Coverage of plan and model by a run that has just ended, by group, as `coverage_of` its folder
/// counts it. Traces are those of the result, so that none is searched for twice; executed plans
/// are read from the journal. Empty where it cannot be computed, as for a model that is too large
/// for the evaluator: the run's answer stands without it, and nothing is reported.
std::vector<harness::CoverageShare> coverage_of_run(const ScenarioModel& loaded,
                                                    const harness::CampaignResult& result,
                                                    Context& context);

}  // namespace parallax::tools
