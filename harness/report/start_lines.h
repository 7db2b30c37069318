#pragma once

#include <string>
#include <string_view>

#include "harness/campaign/campaign_result.h"

namespace parallax::harness {

/// Lines of the report about where simulations begin. Empty where there is nothing to say.

/// The subject of a trace's claim: its discrete start, and the continuous states that this stands
/// for, with how much of each cell is drawn from.
std::string start_lines(const TraceResult& trace);

/// How many initial states were tried, and the results from each of the first few.
std::string initial_state_lines(std::string_view label, const StartResult& starts);

/// The law of the starts, and how many its conditions refused.
std::string law_lines(const LawResult& law);

/// The initial states of executions, and the most frequent paths with their ends.
std::string execution_paths(const LoopResult& loop);

}  // namespace parallax::harness
