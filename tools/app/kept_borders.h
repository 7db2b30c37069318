#pragma once

#include <string>
#include <vector>

#include "harness/campaign/replay.h"
#include "harness/cause/cause_kind.h"

namespace parallax::tools {

/// The folder in a run folder where `parallax confirm` keeps its findings.
inline constexpr const char* kConfirmFile = "confirm/confirm.json";

/// The borders that `parallax confirm` found of this simulation, if it was confirmed; empty where
/// nothing is on record, or it is damaged or of another start.
std::vector<harness::CauseBorder> kept_borders(const std::string& run_dir, harness::SampleId sample,
                                               const harness::State& start);

}  // namespace parallax::tools
