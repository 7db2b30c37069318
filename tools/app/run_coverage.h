#pragma once

#include <vector>

#include "harness/campaign/campaign_result.h"
#include "tools/app/context.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {

/// What a run that has just ended went through of its plan and model, by group, as `coverage_of`
/// its folder counts it. Traces are those of the result, so that none is searched for twice;
/// executed plans are read from the journal. None where that cannot be told, as of a model that is
/// too large for the evaluator: the run's answer stands without it, and nothing is reported.
std::vector<harness::CoverageShare> coverage_of_run(const ScenarioModel& loaded,
                                                    const harness::CampaignResult& result,
                                                    Context& context);

}  // namespace parallax::tools
