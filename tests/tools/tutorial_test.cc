// docs/tutorial/tutorial.md, played from its first command to its last in an empty folder: every
// command prints what the page shows below it, and files are written where the page says so.

#include <doctest/doctest.h>

#include <fstream>
#include <regex>
#include <sstream>
#include <utility>

#include "tests/support/process.h"
#include "tests/tools/cli_fixture.h"
#include "tests/tools/rounded.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

/// One step of the page: a file to write, or a command with the lines below it.
struct Step {
  std::string file;
  std::string command;
  std::vector<std::string> lines;
};

/// The steps of a page. A block is a file's content if the paragraph above it ends with
/// "as `NAME`:"; in other blocks `$ ` begins a command.
std::vector<Step> steps_of(const std::string& page) {
  std::ifstream in(std::string(PARALLAX_SOURCE_DIR) + "/docs/" + page);
  static const std::regex saved("[Ss]ave this as `([^`]+)`:$");
  std::vector<Step> out;
  std::string text;       // the last line of prose
  bool inside = false;    // a block
  std::size_t empty = 0;  // empty lines since its last line
  for (std::string line; std::getline(in, line);) {
    if (line.empty()) {
      ++empty;
      continue;
    }
    if (!line.starts_with("    ")) {
      text = line;
      inside = false;
      continue;
    }
    line.erase(0, 4);
    const bool first = !std::exchange(inside, true);
    if (first) empty = 0;
    std::smatch name;
    if (first && std::regex_search(text, name, saved)) {
      out.push_back({name[1], "", {}});
    } else if (line.starts_with("$ ")) {
      out.push_back({"", line.substr(2), {}});
      empty = 0;
      continue;
    }
    REQUIRE_MESSAGE(!out.empty(), line);
    out.back().lines.insert(out.back().lines.end(), empty, "");
    out.back().lines.push_back(line);
    empty = 0;
  }
  return out;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

/// Whether the printed lines are those shown, where `...` stands for any lines.
bool fits(const std::vector<std::string>& shown, std::size_t s,
          const std::vector<std::string>& printed, std::size_t p) {
  for (; s < shown.size(); ++s, ++p) {
    if (shown[s] == "...") {
      for (auto next = p; next <= printed.size(); ++next) {
        if (fits(shown, s + 1, printed, next)) return true;
      }
      return false;
    }
    if (p == printed.size() || rounded(shown[s]) != rounded(printed[p])) return false;
  }
  return p == printed.size();
}

TEST_CASE("shown lines fit what is printed, and nothing else does") {
  const std::vector<std::string> printed = {"a", "b 1.00004", "c"};
  CHECK(fits({"a", "b 1.00003", "c"}, 0, printed, 0));
  CHECK(fits({"a", "..."}, 0, printed, 0));
  CHECK(fits({"...", "c"}, 0, printed, 0));
  CHECK_FALSE(fits({"a", "b 1.01", "c"}, 0, printed, 0));
  CHECK_FALSE(fits({"a", "..", "c"}, 0, printed, 0));
  CHECK_FALSE(fits({"a", "b 1.00004"}, 0, printed, 0));
  CHECK_FALSE(fits({"...", "b 1.00004"}, 0, printed, 0));
}

TEST_CASE("the tutorial's commands print what the tutorial shows") {
  const CliFixture cli;
  const auto folder = cli.folder() / "tutorial";
  fs::create_directory(folder);
  const auto program = fs::path(CliFixture::program()).parent_path().string();
  std::size_t commands = 0, files = 0;
  for (const auto& step : steps_of("tutorial/tutorial.md")) {
    if (!step.file.empty()) {
      std::ofstream out(folder / step.file);
      for (const auto& line : step.lines) out << line << '\n';
      REQUIRE_MESSAGE(out.good(), step.file);
      ++files;
      continue;
    }
    ProcessOptions options;
    options.folder = folder.string();
    const auto result =
        run_process({"/bin/sh", "-c", "PATH='" + program + "':$PATH; " + step.command}, options);
    CAPTURE(step.command);
    CAPTURE(result.err);
    CHECK(result.code <= 1);
    CHECK_MESSAGE(fits(step.lines, 0, lines_of(result.out), 0), result.out);
    ++commands;
  }
  CHECK(commands > 10);
  CHECK(files == 2);
}

}  // namespace
}  // namespace parallax::test
