#pragma once

#include "tools/cli/command.h"

namespace parallax::tools {

Command diff_command();

}  // namespace parallax::tools
