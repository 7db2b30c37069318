// Manual pages as `man` shows them: complete, and without a warning.

#include <doctest/doctest.h>

#include <filesystem>
#include <regex>

#include "tests/tools/manual/help_text.h"

namespace parallax::test {
namespace {

/// Every page of the program, in a folder of the fixture.
class ManPages {
 public:
  ManPages() {
    std::filesystem::create_directory(folder());
    const auto made = cli.parallax({"man", "--out", "man"});
    CAPTURE(made.err);
    REQUIRE(made.code == 0);
    CHECK(made.out.empty());
  }
  std::filesystem::path folder() const { return cli.folder() / "man"; }
  /// The page as a reader with a wide window sees it.
  ProcessResult shown(const std::string& name) const {
    return run_process({"/usr/bin/env", "MANWIDTH=300", "MAN_KEEP_FORMATTING=", "LC_ALL=C.UTF-8",
                        "man", "--warnings", "-P", "cat", "-l",
                        (folder() / (name + ".1")).string()});
  }

  CliFixture cli;
};

bool stands_in(const std::string& page, const std::string& option) {
  static const std::regex special("[-\\[\\].]");
  const auto name = std::regex_replace(option, special, "\\$&");
  return std::regex_search(page, std::regex("\n +(-[^ ]+, )*" + name + "([ ,\n]|\\[)"));
}

TEST_CASE("every option that `--help` lists is in the page of its command") {
  const ManPages pages;
  if (!is_installed("man")) {
    MESSAGE("man is not installed: pages were not shown");
    return;
  }
  std::size_t options = 0;
  for (const auto& name : listed_commands(pages.cli)) {
    CAPTURE(name);
    const auto page = pages.shown("parallax-" + name);
    CHECK(page.code == 0);
    CHECK(page.err.empty());
    for (const auto& option : read_help(pages.cli.parallax({name, "--help"}).out).options) {
      CHECK_MESSAGE(stands_in(page.out, option), option);
      ++options;
    }
    CHECK_FALSE(stands_in(page.out, "--no-such-option"));
  }
  CHECK(options > 500);
}

TEST_CASE("the program's page names every command, and what is true of all") {
  const ManPages pages;
  if (!is_installed("man")) {
    MESSAGE("man is not installed: pages were not shown");
    return;
  }
  const auto page = pages.shown("parallax");
  CHECK(page.err.empty());
  for (const auto& name : listed_commands(pages.cli)) {
    CHECK_MESSAGE(page.out.find("parallax-" + name + "(1)") != std::string::npos, name);
    CHECK_MESSAGE(std::filesystem::exists(pages.folder() / ("parallax-" + name + ".1")), name);
  }
  for (const auto* section : {"\nEXIT STATUS", "\nFILES", "\nSEEDS", "\nTRUST", "\nEXAMPLES"}) {
    CHECK_MESSAGE(page.out.find(section) != std::string::npos, section);
  }
  // Text to be typed is shown as it is typed.
  CHECK(page.out.find("--property \"!HoldsAt(Broken(),time)\"") != std::string::npos);
}

TEST_CASE("pages are as mandoc wants them") {
  const ManPages pages;
  if (!is_installed("mandoc")) {
    MESSAGE("mandoc is not installed: pages were not looked at by it");
    return;
  }
  for (const auto& entry : std::filesystem::directory_iterator(pages.folder())) {
    const auto found =
        run_process({"mandoc", "-Tlint", "-Wwarning", "-Ios=Debian", entry.path().string()});
    CHECK_MESSAGE(found.code == 0, found.out);
  }
}

TEST_CASE("a page on standard output is the one in the folder") {
  const ManPages pages;
  CHECK(pages.cli.parallax({"man", "traces"}).out == pages.cli.read("man/parallax-traces.1"));
  CHECK(pages.cli.parallax({"man"}).out == pages.cli.read("man/parallax.1"));
  CHECK(pages.cli.parallax({"man", "--out", "nowhere"}).code == 2);
}

}  // namespace
}  // namespace parallax::test
