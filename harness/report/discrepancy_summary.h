#pragma once

#include <string>

#include "harness/campaign/campaign_result.h"
#include "harness/report/report.h"

namespace parallax::harness {

/// Column at which what stands beside a label of a summary begins.
inline constexpr std::size_t kSummaryColumn = 12;

/// Describes how model and world part: "Go(r2) fails (path-blocked: by box), and the model says
/// that it succeeds". Also for executed plans.
std::string discrepancy_sentence(const CampaignResult& result, const Discrepancy& found);

/// The same for the first line of a report.
struct DiscrepancyHeadline {
  std::string sentence;
  std::string reason;  // of the failure, in full, where the sentence has its first words alone
};
/// `columns`: room for the sentence; it leaves out what else a reason says where it does not fit.
DiscrepancyHeadline discrepancy_headline(const CampaignResult& result, const Discrepancy& found,
                                         std::size_t columns);

/// Summarizes a discrepancy in at most 30 lines. They show the events, with the one at which model
/// and world part marked; predicted and observed values of the fluents that differ there, and
/// indented below them those that differ at the end; and the values drawn for the start of the
/// bodies that take part.
std::string discrepancy_summary(const CampaignResult& result, const Discrepancy& found,
                                const ReportStyle& style);

}  // namespace parallax::harness
