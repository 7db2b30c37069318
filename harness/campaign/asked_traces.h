#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "harness/campaign/trial.h"

namespace parallax::harness {

/// Starts the bench, hands `visit` the traces of the feed that are asked for (`asked`: a number; 0:
/// all) until it answers false, and closes the bench. True: all that were asked for were visited,
/// and the feed had reached its end where it had to be known. Reports kNoSuchTrace, what the bench
/// and the feed report, and nothing of what `visit` has.
base::Result<bool> visit_asked_traces(TrialBench& bench, TraceFeed& feed, std::int64_t asked,
                                      const std::string& scenario,
                                      const std::function<base::Result<bool>(CampaignTrace)>& visit,
                                      base::DiagnosticSink& sink);

}  // namespace parallax::harness
