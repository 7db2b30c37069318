#pragma once

#include "tools/cli/command.h"

namespace parallax::tools {

Command explain_command();

}  // namespace parallax::tools
