// Every error and warning has an example that a test runs. Most are named where their subject is
// tested; those that belong to no other test are provoked here.

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

struct Example {
  std::string code, file, text;
  std::vector<std::string> command;
};

const std::string kModel =
    "fluent F()\nevent E()\n[time] Initiates(E(),F(),time).\nsort n: integer\n";

std::vector<Example> examples() {
  const std::string range = "range time 0 1\n";
  return {
      {"E3001", "m.e", range + kModel + "range n 1 1000\nfluent G(n,n,n)\n", {"traces", "m.e"}},
      {"E3002",
       "m.e",
       range + kModel +
           "range n 1 1000\npredicate P(n,n)\n[n1,n2,n3] P(n1,n2) & P(n2,n3) -> P(n1,n3).\n",
       {"traces", "m.e"}},
      {"E3005",
       "m.e",
       range + kModel + "range n 0 3\npredicate P(n)\nP(1/0).\n",
       {"traces", "m.e"}},
      {"E3007",
       "m.e",
       range + kModel +
           "range n 0 3\nfunction G(n): n\nG(1)=2.\n[n,time] G(n)=2 -> Initiates(E(),F(),time).\n",
       {"traces", "m.e"}},
      {"E3009", "m.e", "range time 1 3\n" + kModel, {"check", "m.e"}},
      {"W3001", "m.e", range + kModel + "1=2.\n", {"traces", "m.e", "--compat", "decreasoner"}},
      {"E7006", "empty/note.txt", "", {"suite", "empty"}},
      {"E7118",
       "g.yaml",
       "runs: {lost_traces: forbidden}\n",
       {"diff", "--gate", "g.yaml", "s/domain.e", "s/domain.e"}},
      {"E7403",
       "log.jsonl",
       "{\"t\": 0, \"state\": {}}\n",
       {"monitor", "s/scenario.yaml", "log.jsonl", "--unobserved", "Fly"}},
      {"E5302",
       "s/narrow.yaml",
       "include: scenario.yaml\nsampling: {variables: {box.y: [0, 0.0000001]}}\n",
       {"check", "s/narrow.yaml"}},
      {"E5307",
       "s/fluents.yaml",
       "include: scenario.yaml\nexpect: {verdict: discrepancy, fluents: [Nope(near)]}\n",
       {"check", "s/fluents.yaml"}},
      {"E5308",
       "s/cause.yaml",
       "include: scenario.yaml\nexpect: {cause: {event: Nope(near)}}\n",
       {"check", "s/cause.yaml"}},
      {"E5141",
       "s/rate.yaml",
       "include: scenario.yaml\nexpect: {rate: {below: 0.1, runs: 3}}\n",
       {"check", "s/rate.yaml"}},
  };
}

std::string text_of(const fs::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST_CASE("codes that belong to no other test are provoked") {
  const CliFixture cli;
  REQUIRE(cli.parallax({"new", "s", "--world", "line"}).code == 0);
  fs::create_directory(cli.folder() / "empty");
  for (const auto& [code, file, text, command] : examples()) {
    CAPTURE(code);
    cli.write(file, text);
    const auto result = cli.parallax(command);
    CHECK_MESSAGE(result.err.find("[" + code + "]: ") != std::string::npos, result.err);
    CHECK((code[0] == 'W' || result.code >= 2));
  }
}

TEST_CASE("every code is named in a test") {
  const fs::path root = PARALLAX_SOURCE_DIR;
  std::string tests;
  for (const auto& entry : fs::recursive_directory_iterator(root / "tests")) {
    if (entry.path().extension() == ".cc") tests += text_of(entry.path());
  }
  const std::regex line("PARALLAX_DIAGNOSTIC\\((k\\w+), \"([^\"]+)\"");
  std::size_t codes = 0;
  std::string without;
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(root / "compiler/base/codes")) {
    if (entry.path().extension() != ".def") continue;
    const auto text = text_of(entry.path());
    for (std::sregex_iterator it(text.begin(), text.end(), line), end; it != end; ++it, ++codes) {
      if (tests.find((*it)[2].str()) != std::string::npos) continue;
      if (tests.find("codes::" + (*it)[1].str()) != std::string::npos) continue;
      without += (*it)[2].str() + ' ';
      ++count;
    }
  }
  CHECK(codes > 300);
  // These may only become fewer.
  CHECK_MESSAGE(count <= 10, without);
}

}  // namespace
}  // namespace parallax::test
