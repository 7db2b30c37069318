#pragma once

#include "tools/cli/command.h"
#include "tools/cli/suite_options.h"

namespace parallax::tools {

/// `suite --merge`: reports from the results of shards what one whole suite would have reported;
/// returns the exit code.
int merge_shards(const SuiteOptions& options, Invocation& invocation);

}  // namespace parallax::tools
