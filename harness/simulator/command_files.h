#pragma once

#include <string>
#include <vector>

namespace parallax::harness {

/// The files that a simulator's command names.
struct CommandFiles {
  std::vector<std::string> found;   // the program, then each further word that is a file
  std::vector<std::string> absent;  // paths where the program was sought and not found
};

/// Looks the program up as execvp does. What these files load in turn is not known.
CommandFiles files_of_command(const std::vector<std::string>& command);

/// SHA-256 over the contents of the files that the command names; empty without a command.
std::string hash_of_command(const std::vector<std::string>& command);

}  // namespace parallax::harness
