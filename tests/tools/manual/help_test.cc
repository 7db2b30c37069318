// Help in topics: commands by what one does with them, options below headings, `parallax help`.

#include <doctest/doctest.h>

#include <algorithm>
#include <sstream>

#include "tests/tools/manual/help_text.h"

namespace parallax::test {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_CASE("the program's help lists each command once, below what one does with it") {
  const CliFixture cli;
  const auto help = cli.parallax({"--help"});
  CHECK(help.code == 0);
  for (const auto* subject : {"\nBegin:\n", "\nFind where model and world part:\n",
                              "\nLook into a run:\n", "\nAsk the model:\n"}) {
    CHECK_MESSAGE(has(help.out, subject), subject);
  }
  CHECK_FALSE(has(help.out, "  worker "));
  CHECK_FALSE(has(help.out, "  supervise "));
  auto names = listed_commands(cli);
  std::sort(names.begin(), names.end());
  CHECK(std::adjacent_find(names.begin(), names.end()) == names.end());
  for (const auto& name : names) {
    const auto own = cli.parallax({name, "--help"});
    CHECK_MESSAGE(own.code == 0, name);
    // The options that every command has stand last, with the help itself.
    const auto general = own.out.find("\nGeneral:\n");
    REQUIRE_MESSAGE(general != std::string::npos, name);
    CHECK_MESSAGE(own.out.find("  -h,--help", general) != std::string::npos, name);
    CHECK_MESSAGE(own.out.find("  --json", general) != std::string::npos, name);
  }
}

TEST_CASE("options of a command with many stand below headings of their own") {
  const CliFixture cli;
  const auto help = cli.parallax({"run", "--help"}).out;
  const auto below = [&](const std::string& heading, const std::string& option) {
    const auto at = help.find("\n" + heading + ":\n");
    if (at == std::string::npos) return false;
    const auto end = help.find("\n\n", at + 1);
    return has(help.substr(at, end - at), "  " + option + " ");
  };
  CHECK(below("What is claimed", "--confidence"));
  CHECK(below("Workers on other machines", "--hosts"));
  CHECK(below("Commands that a scenario names", "--no-commands"));
  CHECK(below("General", "--time-limit"));
  CHECK_FALSE(below("General", "--confidence"));
}

TEST_CASE("an option's help is one line; the rest stands in the manual page") {
  constexpr std::size_t kColumn = 30, kMost = 90;  // where CLI11 begins the text
  const CliFixture cli;
  std::size_t seen = 0;
  for (const auto& name : listed_commands(cli)) {
    std::istringstream help(cli.parallax({name, "--help"}).out);
    for (std::string line; std::getline(help, line);) {
      if (line.size() <= kColumn || line.compare(kColumn - 2, 2, "  ") != 0) continue;
      if (line.compare(0, 2, "  ") != 0 || line[kColumn] == ' ') continue;
      ++seen;
      CHECK_MESSAGE(line.size() - kColumn <= kMost, name << ": " << line);
    }
  }
  CHECK(seen > 400);
}

TEST_CASE("`help` tells of commands and topics, and names the nearest where there is none") {
  const CliFixture cli;
  CHECK(cli.parallax({"help"}).out == cli.parallax({"--help"}).out);
  CHECK(cli.parallax({"help", "run"}).out == cli.parallax({"run", "--help"}).out);
  for (const auto* topic : {"exit-codes", "files", "output", "seeds", "trust", "limits"}) {
    const auto told = cli.parallax({"help", topic});
    CHECK_MESSAGE(told.code == 0, topic);
    CHECK_MESSAGE(told.out.size() > 200, topic);
    CHECK_MESSAGE(has(cli.parallax({"help", "--help"}).out, std::string("  ") + topic), topic);
    CHECK_MESSAGE(has(cli.parallax({"--help"}).out, topic), topic);
  }
  CHECK(has(cli.parallax({"help", "exit-codes"}).out, "4    inconclusive"));
  const auto near = cli.parallax({"help", "exit-code"});
  CHECK(near.code == 2);
  CHECK(near.out.empty());
  CHECK(has(near.err, "there is no command or topic `exit-code`"));
  CHECK(has(near.err, "replace `exit-code` with `exit-codes`"));
  CHECK(has(cli.parallax({"help", "rnu"}).err, "with `run`"));
  CHECK(has(cli.parallax({"help", "radians"}).err, "docs/README.md"));
  CHECK(has(cli.parallax({"man", "trcaes"}).err, "with `traces`"));
  // Hidden commands have no help of their own.
  CHECK(cli.parallax({"help", "worker"}).code == 2);
  CHECK(cli.parallax({"help", "\x1b[31m"}).err.find('\x1b') == std::string::npos);
}

}  // namespace
}  // namespace parallax::test
