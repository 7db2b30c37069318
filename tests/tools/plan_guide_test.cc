// docs/reference/plan_language.md: its commands and its binding table work as the page says.

#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

std::vector<std::string> page() {
  std::ifstream in(std::string(PARALLAX_SOURCE_DIR) + "/docs/reference/plan_language.md");
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  REQUIRE(lines.size() > 100);
  return lines;
}

/// The indented blocks, without the indentation.
std::vector<std::string> indented_blocks() {
  std::vector<std::string> blocks;
  bool inside = false, fenced = false;
  for (const auto& line : page()) {
    if (line.starts_with("```")) fenced = !fenced;
    const bool indented = !fenced && line.starts_with("    ");
    if (indented && !inside) blocks.emplace_back();
    if (indented) blocks.back() += line.substr(4) + '\n';
    inside = indented;
  }
  return blocks;
}

/// A file of the plan that the page's table is tried with.
std::string part(const std::string& name) {
  std::ifstream in(std::string(PARALLAX_SOURCE_DIR) + "/tests/plans/page/" + name);
  std::ostringstream text;
  text << in.rdbuf();
  REQUIRE_FALSE(text.str().empty());
  return text.str();
}

TEST_CASE("the commands of the plan language's page run") {
  const CliFixture cli;
  std::size_t count = 0;
  for (const auto& block : indented_blocks()) {
    if (!block.starts_with("parallax ")) continue;
    std::string joined;
    for (std::size_t i = 0; i < block.size(); ++i) {
      if (block[i] == '\\' && block[i + 1] == '\n') {
        ++i;
      } else {
        joined += block[i];
      }
    }
    std::istringstream commands(joined);
    for (std::string command; std::getline(commands, command); ++count) {
      CAPTURE(command);
      ProcessOptions options;
      options.folder = cli.folder().string();
      const auto result =
          run_process({"sh", "-c", "exec " PARALLAX_BINARY_DIR "/" + command}, options);
      CAPTURE(result.err);
      CHECK((result.code == 0 || result.code == 1));
      CHECK(result.err.find("error[") == std::string::npos);
    }
  }
  CHECK(count >= 2);
}

TEST_CASE("the binding table of the plan language's page gives a plan its trace") {
  const CliFixture cli;
  const auto blocks = indented_blocks();
  const auto table = std::find_if(blocks.begin(), blocks.end(), [](const std::string& block) {
    return block.starts_with("motion going");
  });
  REQUIRE(table != blocks.end());
  cli.write("plan.bind", *table + part("more.bind"));
  cli.write("plan.lisp", part("plan.lisp"));
  cli.write("model.e", part("model.e"));
  const auto result =
      cli.parallax({"traces", "model.e", "--plan", "plan.lisp", "--bind", "plan.bind", "--limit",
                    "0", "--until", "HoldsAt(ItemAt(spoon1,dMid),time)"});
  CAPTURE(result.err);
  CHECK(result.code == 0);
  CHECK(result.out == part("traces.txt"));
}

}  // namespace
}  // namespace parallax::test
