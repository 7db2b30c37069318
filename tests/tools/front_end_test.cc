// Commands that end before grounding: fmt, lint, SARIF, stages.

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string kUgly =
    "range   time 0 1\nfluent  F( )\n[time]HoldsAt( F(),time )->HoldsAt(F(),0).\n";
const std::string kTidy =
    "range time 0 1\nfluent F()\n[time] HoldsAt(F(),time) -> HoldsAt(F(),0).\n";

/// The program with a text on standard input.
ProcessResult filtered(const CliFixture& cli, const std::string& file,
                       const std::string& arguments) {
  ProcessOptions options;
  options.folder = cli.folder().string();
  return run_process(
      {"sh", "-c", "exec " PARALLAX_BINARY_DIR "/parallax " + arguments + " < " + file}, options);
}

TEST_CASE("fmt rewrites in place, keeps permissions and links, and is content with its own work") {
  const CliFixture cli;
  cli.write("m.e", kUgly);
  fs::permissions(cli.folder() / "m.e", fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("m.e", cli.folder() / "link.e");
  const auto asked = cli.parallax({"fmt", "--check", "m.e"});
  CHECK(asked.code == 1);
  CHECK(asked.out == "m.e\n");
  CHECK(cli.read("m.e") == kUgly);
  CHECK(cli.parallax({"fmt", "--stdout", "m.e"}).out == kTidy);
  CHECK(cli.read("m.e") == kUgly);
  CHECK(filtered(cli, "m.e", "fmt -").out == kTidy);
  CHECK(cli.parallax({"fmt", "link.e"}).code == 0);
  CHECK(cli.read("m.e") == kTidy);
  CHECK(fs::is_symlink(cli.folder() / "link.e"));
  CHECK((fs::status(cli.folder() / "m.e").permissions() & fs::perms::group_read) ==
        fs::perms::none);
  CHECK(json_of(cli, {"fmt", "--check", "m.e"})["changed"] == json::array());
}

TEST_CASE("the models of this repository are in the standard layout") {
  const fs::path root = PARALLAX_SOURCE_DIR;
  std::vector<std::string> arguments = {"fmt", "--check"};
  for (const auto* folder : {"docs", "scenarios", "tests", "tools"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      // The generator of mistakes reads a sentence from each line.
      if (entry.path().string().find("/bench/mistakes/worlds/") != std::string::npos) continue;
      if (entry.path().extension() == ".e") arguments.push_back(entry.path().string());
    }
  }
  CHECK(arguments.size() > 30);
  const CliFixture cli;
  const auto result = cli.parallax(arguments);
  CHECK(result.code == 0);
  CHECK(result.out == "");
}

TEST_CASE("fmt leaves a file with a syntax error as it is and goes on with the others") {
  const CliFixture cli;
  cli.write("bad.e", "P(  & .\n");
  cli.write("m.e", kUgly);
  const auto result = cli.parallax({"fmt", "bad.e", "m.e"});
  CHECK(result.code == 3);
  CHECK(result.err.find("bad.e:1:") == 0);
  CHECK(cli.read("bad.e") == "P(  & .\n");
  CHECK(cli.read("m.e") == kTidy);
  CHECK(cli.parallax({"fmt", "nowhere.e"}).code == 2);
}

/// The indented blocks of a page, without the indentation.
std::vector<std::string> blocks_of(const std::string& page) {
  std::vector<std::string> blocks;
  std::istringstream in(page);
  std::string line;
  bool inside = false;
  while (std::getline(in, line)) {
    const bool indented = line.starts_with("    ");
    if (indented && !inside) blocks.emplace_back();
    if (indented) blocks.back() += line.substr(4) + '\n';
    inside = indented;
  }
  return blocks;
}

TEST_CASE("docs/guide/models.md shows what the program says and how it formats") {
  const CliFixture cli;
  std::ostringstream page;
  page << std::ifstream(std::string(PARALLAX_SOURCE_DIR) + "/docs/guide/models.md").rdbuf();
  const auto blocks = blocks_of(page.str());
  REQUIRE(blocks.size() > 5);
  cli.write("lamp.e", blocks[1]);
  std::istringstream messages(cli.parallax({"check", "lamp.e"}).err);
  std::string shown, line;
  while (std::getline(messages, line)) {
    if (line.starts_with("lamp.e:")) shown += line + '\n';
  }
  CHECK(shown == blocks[2]);
  const auto formula = std::find_if(blocks.begin(), blocks.end(), [](const std::string& block) {
    return block.starts_with("[agent,object1,");
  });
  REQUIRE(formula != blocks.end());
  std::string flat;
  for (const char c : *formula) flat += c == '\n' ? ' ' : c;
  cli.write("long.e", flat);
  CHECK(cli.parallax({"fmt", "--stdout", "long.e"}).out == *formula);
}

TEST_CASE("lint belongs to check and can be silenced, a difference is told by every command") {
  const CliFixture cli;
  cli.write("m.e",
            "range time 0 1\nfluent F()\nfluent G()\nnoninertial G\nevent E()\nsort unused\n"
            "[time] Initiates(E(),G(),time).\n[time] Initiates(E(),F(),time).\n");
  const auto check = cli.parallax({"check", "m.e"});
  CHECK(check.code == 0);
  CHECK(check.err.find("m.e:6:6-11: warning[W2104]") != std::string::npos);
  CHECK(check.err.find("m.e:7:") != std::string::npos);
  const auto allowed = cli.parallax({"check", "m.e", "--allow", "W2104", "--allow", "W2102"});
  CHECK(allowed.err.find("W2104") == std::string::npos);
  CHECK(allowed.err.find("W2202") != std::string::npos);
  CHECK(cli.parallax({"check", "m.e", "--no-lint"}).err.find("W21") == std::string::npos);
  CHECK(cli.parallax({"check", "m.e", "--allow", "E2101"}).code == 2);
  const auto traces = cli.parallax({"traces", "m.e"});
  CHECK(traces.err.find("W2202") != std::string::npos);
  CHECK(traces.err.find("W21") == std::string::npos);
  CHECK(cli.parallax({"traces", "m.e", "--quiet"}).err.empty());
  const auto old = cli.parallax({"traces", "m.e", "--compat", "decreasoner"});
  CHECK(old.err.find("W2202") == std::string::npos);
}

TEST_CASE("with encoding 3 the old meaning ignores an effect on a noninertial fluent") {
  const CliFixture cli;
  const std::string model =
      "range time 0 1\nfluent G()\nnoninertial G\nevent E()\n[time] Initiates(E(),G(),time).\n"
      "HoldsAt(G(),0) | Happens(E(),0).\nHoldsAt(G(),1) | Happens(E(),0).\n";
  cli.write("m.e", model);
  cli.write("m3.e", "option encoding 3\n" + model);
  const auto count = [&](const std::string& file, std::vector<std::string> more) {
    more.insert(more.begin(), {"traces", file, "--count", "--quiet"});
    return cli.parallax(more).out;
  };
  // Elsewhere the effect makes the fluent inertial, which it never is: E does not happen.
  CHECK(count("m.e", {}) == "1\n");
  CHECK(count("m3.e", {}) == "1\n");
  CHECK(count("m.e", {"--compat", "decreasoner"}) == "1\n");
  CHECK(count("m3.e", {"--compat", "decreasoner"}) == "5\n");
}

TEST_CASE("under the old meaning only those differences are told that remain") {
  const CliFixture cli;
  cli.write(
      "m.e",
      "range time 0 1\nrange time 0 1\nsort a, b\nsort c: a\nsort c: b\nc C\nfluent F()\n"
      "event E()\nL: [time] Initiates(E(),F(),time).\n[c,time]\nc = C -> HoldsAt(F(),time).\n");
  const auto ours = cli.parallax({"check", "m.e", "--no-lint"}).err;
  for (const auto* code : {"W1101", "W2001", "W2007", "W2008"}) {
    CHECK_MESSAGE(ours.find(code) != std::string::npos, code << ours);
  }
  // None of these is followed, so a porter has to know.
  const auto old = cli.parallax({"check", "m.e", "--no-lint", "--compat", "decreasoner"}).err;
  for (const auto* code : {"W1101", "W2001", "W2007", "W2008"}) {
    CHECK_MESSAGE(old.find(code) != std::string::npos, code << old);
  }
  cli.write("facts.e",
            "range time 0 1\nsort num: integer\nrange num 0 3\nfluent F(num)\nfluent G()\n"
            "noninertial G\nevent E(num)\n"
            "[num1,num2,time] num2=num1+num1+1 -> Initiates(E(num1),F(num2),time).\n"
            "[num,time] Initiates(E(num),G(),time).\n"
            "Happens(E(0),0).\n[time] HoldsAt(G(),time) -> Happens(E(0),time).\n"
            "completion Happens\n");
  const auto standard = cli.parallax({"check", "facts.e", "--no-lint"}).err;
  for (const auto* code : {"W2201", "W2202", "W2203"}) {
    CHECK_MESSAGE(standard.find(code) != std::string::npos, code << standard);
  }
  const auto followed =
      cli.parallax({"check", "facts.e", "--no-lint", "--compat", "decreasoner"}).err;
  CHECK_MESSAGE(followed.find("W2203") != std::string::npos, followed);
  for (const auto* code : {"W2201", "W2202"}) {
    CHECK_MESSAGE(followed.find(code) == std::string::npos, code << followed);
  }
}

TEST_CASE("warnings are limited, and the rest is counted") {
  const CliFixture cli;
  std::string text = "range time 0 1\n";
  for (int i = 0; i < 50; ++i) text += "event E" + std::to_string(i) + "()\n";
  cli.write("m.e", text);
  const auto result = cli.parallax({"check", "m.e"});
  CHECK(result.err.find("30 further warnings are not shown") != std::string::npos);
}

TEST_CASE("--diagnostics=sarif prints a log whatever happens") {
  const CliFixture cli;
  const auto sarif = [&](const std::vector<std::string>& arguments) {
    const auto result = cli.parallax(arguments);
    REQUIRE_MESSAGE(json::accept(result.err), result.err);
    return json::parse(result.err)["runs"][0]["results"];
  };
  cli.write("m.e", "range time 0 1\nP().\nQ().\n");
  const auto results = sarif({"check", "m.e", "--diagnostics=sarif"});
  REQUIRE(results.size() == 2);
  CHECK(results[0]["ruleId"] == "E2101");
  CHECK(results[1]["locations"][0]["physicalLocation"]["region"]["startLine"] == 3);
  CHECK(sarif({"check", "domain.e", "start.e", "--horizon", "2", "--no-lint", "--quiet",
               "--diagnostics=sarif", "--json"})
            .is_array());
}

TEST_CASE("--emit prints the stages of the front end") {
  const CliFixture cli;
  cli.write("m.e", "range time 0 1\nevent E() ; note\nevent D()\nmutex E, D\nHappens(E(), 0).\n");
  const auto tokens = cli.parallax({"compile", "m.e", "--emit=tokens"}).out;
  CHECK(tokens.find("2:1 statement event E()\n") != std::string::npos);
  CHECK(tokens.find("5:1 name Happens\n5:8 bracket (\n5:9 name E\n") != std::string::npos);
  CHECK(cli.parallax({"compile", "m.e", "--emit=ast"}).out ==
        "; m.e\nrange time 0 1\nevent E()\nevent D()\nmutex E, D\nHappens(E(),0).\n");
  const auto typed = cli.parallax({"compile", "m.e", "--emit=typed"}).out;
  CHECK(typed.find("[time0] !Happens(E(),time0) | !Happens(D(),time0).\n") != std::string::npos);
  cli.write("typed.e", typed);
  CHECK(cli.parallax({"compile", "typed.e", "--emit=typed"}).out == typed);
  CHECK(cli.parallax({"traces", "typed.e", "--count"}).out ==
        cli.parallax({"traces", "m.e", "--count"}).out);
  cli.write("bad.e", "P().\n");
  const auto bad = cli.parallax({"compile", "bad.e", "--emit=typed"});
  CHECK(bad.code == 3);
  CHECK(bad.out.empty());
}

}  // namespace
}  // namespace parallax::test
