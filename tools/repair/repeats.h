#pragma once

#include <cstdint>
#include <vector>

#include "harness/campaign/trace_input.h"
#include "tools/repair/repair_input.h"

namespace parallax::tools {

/// Does chance decide something in the scenario's world? For a model it is known: it releases
/// fluents, or has noninertial ones that the repaired model does not define. Other worlds do not
/// tell.
bool chance_decides(const RepairInput& input);

/// A trace to repeat, up to the step that went wrong, and how often.
struct Repeat {
  harness::CampaignTrace trace;
  std::int64_t times = 0;
};

/// Steps at which runs of the folder, not experiments, left the model, observed so seldom and
/// always with the same outcome that they do not tell whether the event always has it.
std::vector<Repeat> repeats_wanted(const RepairInput& input);

}  // namespace parallax::tools
