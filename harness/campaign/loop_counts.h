#pragma once

#include <string>

#include "harness/campaign/campaign_result.h"
#include "harness/campaign/sample_record.h"
#include "harness/confidence/criterion.h"
#include "harness/confidence/item_bounds.h"
#include "harness/config/scenario.h"

namespace parallax::harness {

/// Counts an execution among those that went the same way.
void count_path(const SampleRecord& record, LoopResult& loop);

/// States the bound and the claim of executions whose starts were drawn so. Nothing is claimed
/// where one did not end.
void claim_executions(const Scenario& scenario, const Tally& tally, DrawnStarts drawn,
                      TraceResult& stream);

/// Caveats about executions that did not end, and starts that were chosen by a guide.
void add_loop_caveats(TraceResult& stream);

/// Sets the rates of the causes with their intervals, at 95 %, and puts the most frequent first;
/// adds what is to be known of them to the caveats. `counted`: the executions that rates are about;
/// `lost_too_often`: the run ended before it had made all of these; `interrupted`: at a moment that
/// was not planned.
void rate_causes(const FixedCount& counted, bool lost_too_often, bool interrupted,
                 TraceResult& stream);

/// The reason why the plan did not come to its end; empty if it did.
std::string why_unfinished(const ExecutedPath& path, const Scenario& scenario);

}  // namespace parallax::harness
