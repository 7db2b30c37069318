#pragma once

#include <string>
#include <vector>

#include "harness/campaign/campaign.h"
#include "tools/repair/experiments.h"

namespace parallax::tools {

/// Runs a scenario that was loaded to be run: as `parallax run` does with these options, of which
/// jobs, identity and the rest of `experiments` are filled in. Reports what running reports.
base::Result<harness::CampaignResult> run_plan(ScenarioModel& loaded,
                                               harness::CampaignOptions options,
                                               const ExperimentOptions& experiments,
                                               Context& context);

/// Runs the plan a few times with another text for the model, which closed loop asks for the starts
/// alone, and reads what was seen, up to the first event that failed. Everything is made in a
/// temporary folder. Empty where it could not be run; nothing is reported then.
std::vector<Evidence> runs_of_plan(ScenarioModel loaded, const std::string& model,
                                   const ExperimentOptions& experiments, Context& context);

/// Cuts a run behind its first event that failed: there a world lets time pass, and the plan was
/// told.
void end_at_refusal(Evidence& seen);

}  // namespace parallax::tools
