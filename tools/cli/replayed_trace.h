#pragma once

#include <string>

#include "compiler/base/source_file.h"
#include "tools/app/traces_replay.h"

namespace parallax::tools {

/// `trace 2: fails at timepoint 3, domain.e:14`: a line of the answer of `traces --replay`.
std::string replayed_text(const ReplayedTrace& trace, const base::SourceFiles& files);
/// The whole answer as one JSON object, with the end of the line.
std::string replay_document(const ReplayedTraces& replay, const base::SourceFiles& files);

}  // namespace parallax::tools
