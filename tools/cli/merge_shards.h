#pragma once

#include "tools/cli/command.h"
#include "tools/cli/suite_options.h"

namespace parallax::tools {

/// `suite --merge`: reports of the results of shards what one suite would have reported; the exit
/// code.
int merge_shards(const SuiteOptions& options, Invocation& invocation);

}  // namespace parallax::tools
