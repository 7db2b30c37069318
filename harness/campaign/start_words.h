#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/campaign/campaign_result.h"
#include "harness/campaign/trial.h"

namespace parallax::harness {

/// How a simulation ended, for the counts of its initial state.
enum class StartOutcome : std::uint8_t { kClean, kDiscrepancy, kLost };

/// Counts a simulation by the number of its initial state; 0: there is one only. `text` says what
/// tells a state from the others; it is asked when the first one begins in the state.
void count_start(std::int64_t state, StartOutcome outcome,
                 const std::function<std::string(std::int64_t)>& text, StartResult& result);
/// The same of a sample of a trace.
void count_start(const StartStates& states, const TrialSample& sample, StartResult& result);

/// The law of a trace's starts, with its initial states.
DrawnStarts drawn_starts(const TraceResult& result, DrawnStarts drawn);

/// "6", or "more than 10000": the number of initial states.
std::string states_text(const StartResult& starts);
/// "in 7 of 24 initial states", of all traces together; empty where each was tried, and no trace
/// has others that the scenario leaves out.
std::string in_states_text(const CampaignResult& result);
/// "drawing initial states ended: 3 of 2003 candidates (0.2 %) led to these events", of the first
/// trace whose drawing did; empty where none did.
std::string ran_out_text(const CampaignResult& result);
std::string ran_out_text(const StartResult& starts);
/// "5 of 6 initial states tried", with what was refused; empty where there is one.
std::string tried_text(const StartResult& starts);

/// "2 of 3 runs from TrolleyAt(onWay)", for each initial state with a discrepancy, the first few.
std::vector<std::string> failing_states(const StartResult& starts);

/// Caveats about initial states that were not simulated. `counted`: the runs that count for the
/// claim; `most`: the limit of runs.
void add_start_caveats(const StartResult& starts, std::int64_t counted, std::int64_t most,
                       std::vector<std::string>& caveats);

/// The claim of a trace whose discrepancy came in a run that counts for no claim.
inline constexpr std::string_view kFoundByVisit =
    "a run from an initial state that no counted run began in gave a discrepancy; nothing is "
    "claimed about how often there is one";

}  // namespace parallax::harness
