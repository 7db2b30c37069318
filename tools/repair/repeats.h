#pragma once

#include <cstdint>
#include <vector>

#include "harness/campaign/trace_input.h"
#include "tools/repair/repair_input.h"

namespace parallax::tools {

/// Does chance decide something in the scenario's world? Of a model it is known: it releases
/// fluents, or has noninertial ones that the repaired model does not define. Of other worlds it is
/// not said.
bool chance_decides(const RepairInput& input);

/// What is to be done once more, up to the step that went wrong, and how often.
struct Repeat {
  harness::CampaignTrace trace;
  std::int64_t times = 0;
};

/// Steps at which runs of the folder, not experiments, left the model, that were seen so seldom,
/// and always alike, that nothing tells what the event does from what it may do.
std::vector<Repeat> repeats_wanted(const RepairInput& input);

}  // namespace parallax::tools
