#pragma once

#include <string>

#include "harness/campaign/campaign_result.h"
#include "harness/campaign/sample_record.h"
#include "harness/config/scenario.h"

namespace parallax::harness {

/// Counts an execution among those that went the same way.
void count_path(const SampleRecord& record, LoopResult& loop);

/// The reason why the plan did not come to its end; empty if it did.
std::string why_unfinished(const ExecutedPath& path, const Scenario& scenario);

}  // namespace parallax::harness
