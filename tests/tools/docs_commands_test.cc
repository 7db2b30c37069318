// Every block with `$ parallax` in the documentation: its commands are run in a folder with the
// project's scenarios, page by page, and print what the page shows below them. A block that is not
// run says why, in a comment of the page.

#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <set>

#include "tests/support/process.h"
#include "tests/tools/cli_fixture.h"
#include "tests/tools/page_steps.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

const fs::path& root() {
  static const fs::path folder = PARALLAX_SOURCE_DIR;
  return folder;
}

/// The pages below docs/, but for the tutorial, which has a test of its own.
std::vector<std::string> pages() {
  std::vector<std::string> out;
  for (const auto& entry : fs::recursive_directory_iterator(root() / "docs")) {
    if (entry.path().extension() != ".md") continue;
    auto page = fs::relative(entry.path(), root() / "docs").generic_string();
    if (page != "tutorial/tutorial.md") out.push_back(std::move(page));
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// A test of this name: a source file, or a name in a list of CMake.
bool is_test(const std::string& name) {
  for (const auto& entry : fs::recursive_directory_iterator(root() / "tests")) {
    if (entry.path().stem() == name) return true;
  }
  return false;
}

void play(const CliFixture& cli, const PageStep& step) {
  const auto program = fs::path(CliFixture::program()).parent_path().string();
  ProcessOptions options;
  options.folder = cli.folder().string();
  const auto result =
      run_process({"/bin/sh", "-c", "PATH='" + program + "':$PATH; " + step.command}, options);
  CAPTURE(step.line);
  CAPTURE(step.command);
  CAPTURE(result.err);
  if (step.exit_code >= 0) {
    CHECK(result.code == step.exit_code);
  } else {
    CHECK((result.code == 0 || result.code == 1));
  }
  // A command without output shown is only run.
  if (!step.lines.empty()) CHECK_MESSAGE(fits(step.lines, lines_of(result.out)), result.out);
}

TEST_CASE("the commands of every page print what the page shows") {
  std::size_t run = 0, left_out = 0;
  for (const auto& page : pages()) {
    const auto steps = page_steps(page);
    const auto is_run = [](const PageStep& step) {
      return !step.command.empty() && step.not_run.empty();
    };
    CAPTURE(page);
    for (const auto& step : steps) {
      if (step.not_run.empty()) continue;
      ++left_out;
      std::cout << "docs/" << page << ":" << step.line << ": " << step.not_run << '\n';
      if (step.not_run.starts_with("run by ")) CHECK(is_test(step.not_run.substr(7)));
    }
    if (std::none_of(steps.begin(), steps.end(), is_run)) continue;
    const CliFixture cli;
    fs::copy(root() / "scenarios", cli.folder() / "scenarios", fs::copy_options::recursive);
    for (const auto& step : steps) {
      if (!step.file.empty()) {
        std::string text;
        for (const auto& line : step.lines) text += line + '\n';
        cli.write(step.file, text);
      } else if (is_run(step)) {
        play(cli, step);
        ++run;
      }
    }
  }
  CHECK(run > 15);
  CHECK(left_out < 40);
}

}  // namespace
}  // namespace parallax::test
