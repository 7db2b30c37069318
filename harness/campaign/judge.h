#pragma once

#include <cstdint>
#include <map>
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
  /// Where the simulation left the trace and did not come back; none if the last state agrees.
  std::optional<std::int64_t> parted;
  std::vector<DivergingFluent> at_parting;  // what differs there
  std::vector<DivergingFluent> last;        // what differs at the last timepoint
  /// Every compared fluent at the last timepoint.
  std::map<compiler::FluentId, bool> last_state;
  bool in_no_state = false;       // the last state is one that no state of a model stands for
  std::set<std::string> missing;  // variables that the mapping asks for in vain
  bool matches() const { return last.empty(); }
};

/// `fluents` of the trace's symbols; `observations` has one state per timepoint of the trace.
Judgement judge(const StateMapping& mapping, const ModelFluents& fluents,
                const CampaignTrace& trace, const std::vector<State>& observations);

/// Why the last state of a judged simulation differs from that of the trace; it has to differ.
Cause cause_of(const CampaignTrace& trace, const Judgement& judgement,
               const std::vector<ActionOutcome>& outcomes);

/// The fluents that are ignored on purpose, one entry a symbol: "LookingAt(..)", "Tired()".
std::vector<std::string> ignored_fluents(const StateMapping& mapping,
                                         const std::vector<GroundFluent>& fluents);

/// The part of an observation that the compared fluents are read from.
State mapped_part(const StateMapping& mapping, const std::vector<GroundFluent>& fluents,
                  const State& observation);

}  // namespace parallax::harness
