#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {

/// Content of `--help`, read as a person reads it: nothing here shares code with what is tested.
struct HelpText {
  std::vector<std::string> options;                        // "--jobs", "-j"; as they stand
  std::map<std::string, std::vector<std::string>> values;  // of options with a closed set
};

/// The commands that `parallax --help` lists.
std::vector<std::string> listed_commands(const CliFixture& cli);
HelpText read_help(const std::string& help);

bool is_installed(const std::string& program);

}  // namespace parallax::test
