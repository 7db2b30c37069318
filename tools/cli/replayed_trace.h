#pragma once

#include <string>

#include "compiler/base/source_file.h"
#include "tools/app/traces_replay.h"
#include "tools/cli/command.h"
#include "tools/cli/shared_options.h"

namespace parallax::tools {

/// `trace 2: fails at timepoint 3, domain.e:14`: a line of the answer of `traces --replay`.
std::string replayed_text(const ReplayedTrace& trace, const base::SourceFiles& files);
/// The whole answer as one JSON object, with the end of the line.
std::string replay_document(const ReplayedTraces& replay, const base::SourceFiles& files);
/// Answers `traces --replay`: a line for each trace as it is done, or the document. The exit code.
int answer_replay(const ModelOptions& model, const ReplayTracesOptions& options,
                  Invocation& invocation);

}  // namespace parallax::tools
