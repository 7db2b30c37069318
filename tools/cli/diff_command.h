#pragma once

#include "tools/cli/command.h"

namespace parallax::tools {

Command add_diff_command(CLI::App& app);

}  // namespace parallax::tools
