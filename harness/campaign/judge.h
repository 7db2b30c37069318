#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/campaign/campaign_result.h"
#include "harness/campaign/trace_input.h"
#include "harness/region/state_mapping.h"

namespace parallax::harness {

/// What the observations of one simulation say about the trace, on every fluent with a mapping.
struct Judgement {
  std::optional<std::int64_t> first_divergence;  // timepoint
  std::vector<DivergingFluent> first;            // what differs there
  std::vector<DivergingFluent> last;             // what differs at the last timepoint
  std::set<std::string> missing;                 // variables that the mapping asks for in vain
  bool matches() const { return last.empty(); }
};

/// `observations` has one state per timepoint of the trace.
Judgement judge(const StateMapping& mapping, const std::vector<GroundFluent>& fluents,
                const CampaignTrace& trace, const std::vector<State>& observations);

}  // namespace parallax::harness
