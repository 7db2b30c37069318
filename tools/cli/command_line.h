#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/cli/option_table.h"

namespace parallax::tools {

/// A program and its commands. The tables outlive the parsing.
struct Program {
  const OptionTable& table;
  std::string version;         // what --version prints; empty: no such option
  bool needs_command = false;  // a line without a command is refused
  std::vector<const OptionTable*> commands;
};

struct ParsedLine {
  std::optional<std::size_t> command;  // index into Program::commands, also after an error
  std::optional<int> exit_code;        // the program is to end: help was asked for, or an error
  std::string output, messages;        // then: what to print on standard output and on error
  std::string error;                   // what is wrong with the line
  std::vector<std::string> known;      // with an error: names that were possible there
};

/// Parses the line into the targets of the tables.
ParsedLine parse_command_line(const Program& program, int argc, char** argv);

/// For simple programs: parses, and prints the help or error.
ParsedLine parse_and_print(const Program& program, int argc, char** argv);

}  // namespace parallax::tools
