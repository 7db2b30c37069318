#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "harness/campaign/trial.h"

namespace parallax::harness {

/// Starts the bench, hands the requested traces of the feed to `visit` until it returns false, and
/// closes the bench. `asked`: the number of a trace; 0: all. True: all requested traces were
/// visited, and the feed had reached its end where it had to be known. Reports kNoSuchTrace and
/// what the bench and the feed report, but nothing for `visit`.
base::Result<bool> visit_asked_traces(TrialBench& bench, TraceFeed& feed, std::int64_t asked,
                                      const std::string& scenario,
                                      const std::function<base::Result<bool>(CampaignTrace)>& visit,
                                      base::DiagnosticSink& sink);

}  // namespace parallax::harness
