#pragma once

#include "tools/cli/command.h"

namespace parallax::tools {

Command add_explain_command(CLI::App& app);

}  // namespace parallax::tools
