// scenarios/cram: what CRAM's projection answered, played back, and a world of facts behind a pipe.

#include <doctest/doctest.h>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Runs a scenario of a copy of the folder, with the program on the PATH.
struct CramFolder : CliFixture {
  CramFolder() {
    fs::copy(fs::path(PARALLAX_SOURCE_DIR) / "scenarios" / "cram", folder() / "cram",
             fs::copy_options::recursive);
  }
  ProcessResult run(const std::string& scenario, const std::string& options) const {
    ProcessOptions process;
    process.folder = (folder() / "cram").string();
    const auto bin = fs::path(program()).parent_path().string();
    return run_process(
        {"/bin/sh", "-c",
         "PATH='" + bin + "':$PATH; parallax run " + scenario + " --allow-commands " + options},
        process);
  }
};

TEST_CASE("what CRAM's projection answered gives the paper's third discrepancy") {
  const CramFolder cram;
  const auto once = cram.run("spoon.yaml", "--jobs 1 --out once");
  CAPTURE(once.err);
  CHECK(once.code == 1);
  CHECK(has(once.out,
            "Detect(spoon) fails, and the model says that it succeeds\n"
            "  reason    perception-object-not-found: "));
  CHECK(has(once.out, "runs      1 clean of 2\n"));
  const auto again = cram.run("spoon.yaml", "--jobs 2 --out again");
  CHECK(again.code == 1);
  CHECK(cram.read("cram/once/journal.ndjson") == cram.read("cram/again/journal.ndjson"));
}

TEST_CASE("what was not asked of CRAM's projection is no answer of it") {
  const CramFolder cram;
  const auto other = cram.run("spoon.yaml", "--seed 2 --out other");
  CAPTURE(other.out);
  CHECK(other.code != 0);
  CHECK(other.code != 1);
  CHECK(has(other.err, "not_recorded"));
}

TEST_CASE("a world of facts shows the paper's second discrepancy") {
  const CramFolder cram;
  const auto found = cram.run("symbolic.yaml", "--out found");
  CAPTURE(found.err);
  CHECK(found.code == 1);
  CHECK(has(found.out, "*  7  Go(bSink)      spoon.lisp:11  failed: navigation-pose-unreachable"));
  // Up to the island the model is right.
  cram.replace("cram/spoon.lisp", "\n    (drive-to *sink-pose*)))", "))");
  cram.replace("cram/symbolic.yaml", "Happens(Go(bSink),time-1) & HoldsAt(RobotAt(bSink),time)",
               "Happens(Go(bIsland),time-1) & HoldsAt(RobotAt(bIsland),time)");
  const auto clean = cram.run("symbolic.yaml", "--out clean --max-runs 3");
  CAPTURE(clean.err);
  CHECK(clean.code == 4);
  CHECK(has(clean.out, "3 clean of 3"));
}

TEST_CASE("the world of facts keeps the protocol") {
  const CramFolder cram;
  ProcessOptions process;
  process.folder = (cram.folder() / "cram").string();
  const auto checked = cram.parallax({"adapter-check", "--scenario", "symbolic.yaml"}, process);
  CHECK_MESSAGE(checked.code == 0, checked.out);
}

}  // namespace
}  // namespace parallax::test
