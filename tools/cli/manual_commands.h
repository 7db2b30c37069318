#pragma once

#include <vector>

#include "tools/cli/command.h"
#include "tools/cli/command_line.h"

namespace parallax::tools {

/// The commands that tell of the others: help, man, completion. `program` has all commands when one
/// of them runs; `commands` are those that there are besides.
std::vector<Command> manual_commands(const Program& program, const std::vector<Command>& commands);

}  // namespace parallax::tools
