#include "tests/tools/manual/help_text.h"

#include <doctest/doctest.h>

#include <regex>
#include <sstream>

namespace parallax::test {
namespace {

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, at);) parts.push_back(part);
  return parts;
}

}  // namespace

std::vector<std::string> listed_commands(const CliFixture& cli) {
  static const std::regex line("  ([a-z][a-z-]*) +[^ ].*");
  std::vector<std::string> names;
  bool in_commands = false;
  for (const auto& text : split(cli.parallax({"--help"}).out, '\n')) {
    if (text == "Begin:") in_commands = true;  // the first heading of commands
    if (text == "Examples:") break;
    std::smatch found;
    if (in_commands && std::regex_match(text, found, line)) names.push_back(found[1]);
  }
  REQUIRE(names.size() > 30);
  return names;
}

HelpText read_help(const std::string& help) {
  static const std::regex option("  (-[^ ]+)(.*)");
  static const std::regex closed(" [A-Z]+:\\{([^}]*)\\}.*");
  HelpText out;
  for (const auto& line : split(help, '\n')) {
    std::smatch found;
    if (!std::regex_match(line, found, option)) continue;
    const auto names = split(found[1], ',');
    const std::string rest = found[2];
    std::smatch set;
    for (const auto& name : names) {
      out.options.push_back(name);
      if (std::regex_match(rest, set, closed)) out.values[name] = split(set[1], ',');
    }
  }
  return out;
}

bool is_installed(const std::string& program) {
  return run_process({"/bin/sh", "-c", "command -v " + program}).code == 0;
}

}  // namespace parallax::test
