#pragma once

#include <vector>

#include "tools/cli/command.h"
#include "tools/cli/command_line.h"

namespace parallax::tools {

/// The commands about other commands: help, man, completion. `program` has all commands when one of
/// them runs; `commands` are the other ones.
std::vector<Command> manual_commands(const Program& program, const std::vector<Command>& commands);

}  // namespace parallax::tools
