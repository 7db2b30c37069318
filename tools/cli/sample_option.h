#pragma once

#include <optional>
#include <string>

#include "compiler/base/diagnostic.h"
#include "harness/campaign/replay.h"

namespace parallax::tools {

/// The value of `--sample` of commands that take a recorded run: none if it was not given. Reports
/// kUsage if it is no `TRACE.SAMPLE`.
base::Result<std::optional<harness::SampleId>> parse_sample_option(const std::string& text,
                                                                   base::DiagnosticSink& sink);

}  // namespace parallax::tools
