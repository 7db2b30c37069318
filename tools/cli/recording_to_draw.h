#pragma once

#include <optional>
#include <string>

#include "harness/campaign/replay.h"
#include "harness/recording/recording.h"
#include "harness/world/world_spec.h"

namespace parallax::tools {

/// The recording of a simulation, if it can replace it: it is whole, of this world (null: of
/// another simulator's), and agrees with the journal. None, and `why`, otherwise.
std::optional<harness::Recording> recording_to_draw(const std::string& folder,
                                                    const harness::RecordedRun& run,
                                                    const harness::WorldSpec* spec,
                                                    std::string& why);

}  // namespace parallax::tools
