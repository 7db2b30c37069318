// Failed writes are reported, with an exit code other than 0: on standard output and in files.

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

/// `parallax WORDS` by a shell, behind `before` and before `after`.
ProcessResult shell(const CliFixture& cli, const std::string& before, const std::string& words,
                    const std::string& after = "") {
  const auto line = before + " '" + CliFixture::program() + "' " + words + " " + after;
  return run_process({"/bin/sh", "-c", line}, {cli.folder().string(), {}});
}

/// The names of all commands, as help lists them.
std::vector<std::string> commands(const CliFixture& cli) {
  const auto help = cli.parallax({"help"}).out;
  std::vector<std::string> names;
  for (std::size_t at = 0; at < help.size(); at = help.find('\n', at) + 1) {
    const auto end = help.find_first_of(" \n", at + 2);
    if (help.compare(at, 2, "  ") != 0 || help[at + 2] == ' ' || help[at + 2] == '-') continue;
    names.push_back(help.substr(at + 2, end - at - 2));
  }
  return names;
}

TEST_CASE("help, versions and results that standard output does not take end with another code") {
  const CliFixture cli;
  for (const char* words :
       {"--version", "--help", "help", "help trust", "diagnostics", "traces domain.e --horizon 1",
        "traces domain.e --horizon 1 --json", "traces domain.e --horizon 1 --count",
        "traces domain.e --horizon 1 --format csv", "check scenario.yaml --json",
        "compile domain.e --horizon 1", "compile domain.e --horizon 1 --json -o d.cnf",
        "fmt domain.e --stdout", "verify domain.e --horizon 1 --property 'time>=0'",
        "traces none.e --json", "no-command --json", "consequences domain.e --horizon 1",
        "doctor --help", "help --man"}) {
    CAPTURE(std::string(words));
    const auto result = shell(cli, "exec", words, ">/dev/full");
    CHECK(result.code != 0);
    CHECK(result.code < 128);
    CHECK(result.err != "");
  }
}

TEST_CASE("the help of every command is checked for having been written") {
  const CliFixture cli;
  const auto names = commands(cli);
  REQUIRE(names.size() > 25);
  for (const auto& name : names) {
    CAPTURE(name);
    CHECK(shell(cli, "exec", name + " --help", ">/dev/full").code != 0);
    CHECK(shell(cli, "exec", name + " --help", ">/dev/null").code == 0);
  }
}

TEST_CASE("a reader that has seen enough ends the program without a word") {
  const CliFixture cli;
  const auto result = shell(cli, "", "traces domain.e --horizon 2 --limit 0", "| head -n 1");
  CHECK(result.err.find("error") == std::string::npos);
}

TEST_CASE("files that cannot be written whole are told and not left behind") {
  const CliFixture cli;
  REQUIRE(cli.parallax({"run", "wrong_model.yaml", "--out", "r"}).code == 1);
  for (const char* words :
       {"run wrong_model.yaml --out new", "report r -o page.html", "draw r --out pictures",
        "compile domain.e --horizon 1 -o d.cnf",
        "suite wrong_model.yaml --no-cache --out s --junit j.xml",
        "rates wrong_model.yaml --runs 2 --samples s.csv", "new fresh", "export r -o m.csv",
        "traces domain.e --horizon 1 --limit 0 --certify=d.drat",
        "check scenario.yaml --footprint f.json", "coverage r --lcov c.lcov", "replay r --record",
        "confirm r", "repair r --loop --out repaired"}) {
    CAPTURE(std::string(words));
    const auto result = shell(cli, "ulimit -f 0; exec", words);
    CHECK(result.code != 0);
    CHECK(result.code < 128);
    CHECK(result.err.find("error[E") != std::string::npos);
  }
  for (const auto& [name, text] : files_below(cli.folder())) {
    CHECK(name.find(".tmp") == std::string::npos);
  }
}

}  // namespace
}  // namespace parallax::test
