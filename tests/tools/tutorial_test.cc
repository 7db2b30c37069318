// docs/tutorial/tutorial.md, played from its first command to its last in an empty folder: every
// command prints what the page shows below it, and files are written where the page says so.

#include <doctest/doctest.h>

#include <fstream>

#include "tests/support/process.h"
#include "tests/tools/cli_fixture.h"
#include "tests/tools/page_steps.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

TEST_CASE("shown lines fit what is printed, and nothing else does") {
  const std::vector<std::string> printed = {"a", "b 1.00004", "c"};
  CHECK(fits({"a", "b 1.00003", "c"}, printed));
  CHECK(fits({"a", "..."}, printed));
  CHECK(fits({"a", "  ..."}, printed));
  CHECK(fits({"...", "c"}, printed));
  CHECK_FALSE(fits({"a", "b 1.01", "c"}, printed));
  CHECK_FALSE(fits({"a", "b ..."}, printed));
  CHECK_FALSE(fits({"a", "b 1.00004"}, printed));
  CHECK_FALSE(fits({"...", "b 1.00004"}, printed));
}

TEST_CASE("the tutorial's commands print what the tutorial shows") {
  const CliFixture cli;
  const auto folder = cli.folder() / "tutorial";
  fs::create_directory(folder);
  const auto program = fs::path(CliFixture::program()).parent_path().string();
  std::size_t commands = 0, files = 0;
  for (const auto& step : page_steps("tutorial/tutorial.md")) {
    CHECK_MESSAGE(step.not_run.empty(), "line " << step.line << " is not run");
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
    CHECK_MESSAGE(fits(step.lines, lines_of(result.out)), result.out);
    ++commands;
  }
  CHECK(commands > 10);
  CHECK(files == 3);
}

}  // namespace
}  // namespace parallax::test
