#pragma once

#include <string>

#include "harness/campaign/campaign_result.h"
#include "harness/report/report.h"

namespace parallax::harness {

/// Column at which what stands beside a label of a summary begins.
inline constexpr std::size_t kSummaryColumn = 12;

/// What parted model and world: "Go(r2) fails (path-blocked: by box), and the model says that it
/// succeeds". Also of executed plans.
std::string discrepancy_sentence(const CampaignResult& result, const Discrepancy& found);

/// What happened, with the event at which they part marked; what was predicted and observed of the
/// fluents that differ there, and indented below them those that differ at the end; what was drawn
/// of the start for the bodies that take part. At most 30 lines.
std::string discrepancy_summary(const CampaignResult& result, const Discrepancy& found,
                                const ReportStyle& style);

}  // namespace parallax::harness
