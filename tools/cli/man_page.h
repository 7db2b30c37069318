#pragma once

#include <string>

#include "tools/cli/command_line.h"

namespace parallax::tools {

/// Version and date that stand at the foot of each page.
struct ManualEdition {
  std::string version;  // "0.2.0"
  std::string date;     // "2026-11-26"
};

/// Pages of section 1 for `man`, made of the tables that parse the line: of the program, with what
/// is true of all commands, and of one command.
std::string program_page(const Program& program, const ManualEdition& edition);
std::string command_page(const Program& program, const OptionTable& command,
                         const ManualEdition& edition);

}  // namespace parallax::tools
