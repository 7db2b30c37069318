#pragma once

#include <string>
#include <vector>

#include "harness/campaign/trace_input.h"
#include "harness/config/scenario.h"

namespace parallax::harness {

/// Reports that so many starts of a sample in a row were invalid: at the region where the first of
/// the bodies that `reason` names in backquotes is put, else at the body, with a note at the other
/// one; at `sampling` if it names none of the scenario.
base::DiagnosticBuilder report_rejected(const Scenario& scenario, const CampaignTrace& trace,
                                        std::int64_t rejected, std::int64_t sample,
                                        const std::string& reason, base::DiagnosticSink& sink);

}  // namespace parallax::harness
