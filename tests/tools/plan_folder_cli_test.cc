// Plans of several files and packages, on the command line and in scenarios.

#include <doctest/doctest.h>

#include <string>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The plan of the two regions as two files in two packages; their names are in the wrong order.
class FolderFixture : public CliFixture {
 public:
  FolderFixture() {
    std::filesystem::create_directory(folder() / "robot_plans");
    auto plan = read("fetch.lisp");
    const auto call = plan.rfind("(fetch-box)");
    plan.resize(call);
    write("robot_plans/z_plans.lisp", "(in-package :fetching)\n" + plan);
    write("robot_plans/a_main.lisp", "(in-package :demo)\n(fetch:fetch-box)\n");
    write("robot_plans/packages.lisp",
          "(defpackage :fetching (:use :cl :cpl) (:nicknames :fetch) (:export #:fetch-box))\n"
          "(defpackage :demo (:use :cl))\n");
    system(
        "((:file \"packages\") (:file \"a_main\" :depends-on (\"z_plans\"))\n"
        " (:file \"z_plans\" :depends-on (\"packages\")))");
    write("whole.yaml", "include: scenario.yaml\nplan: robot_plans\n");
  }
  void system(const std::string& components) const {
    write(
        "robot_plans/robot-plans.asd",
        "(defsystem robot-plans :depends-on (:cram-language)\n :components " + components + ")\n");
  }
  ProcessResult traces(const std::vector<std::string>& plans) const {
    std::vector<std::string> line = {"traces", "domain.e", "start.e"};
    for (const auto& plan : plans) line.insert(line.end(), {"--plan", plan});
    for (const char* word :
         {"--bind", "robot.bind", "--regions", "scenario.yaml", "--horizon", "6", "--count"}) {
      line.emplace_back(word);
    }
    return parallax(line);
  }
};

TEST_CASE("a plan folder, its files in order and one file with all of it are the same plan") {
  const FolderFixture cli;
  const auto one = cli.traces({"fetch.lisp"});
  CAPTURE(one.err);
  REQUIRE(one.code == 0);
  for (const auto& plans : std::vector<std::vector<std::string>>{
           {"robot_plans"},
           {"robot_plans/packages.lisp", "robot_plans/z_plans.lisp", "robot_plans/a_main.lisp"}}) {
    const auto several = cli.traces(plans);
    CAPTURE(several.err);
    CHECK(several.code == 0);
    CHECK(several.out == one.out);
  }
  const auto twice = cli.traces({"robot_plans", "robot_plans/a_main.lisp"});
  CHECK(twice.code == 3);
  CHECK(contains(twice.err, "CPL062"));
  std::filesystem::remove(cli.folder() / "robot_plans/robot-plans.asd");
  const auto unordered = cli.traces({"robot_plans"});
  CHECK(unordered.code == 3);  // a_main comes before the package that it is in
  CHECK(contains(unordered.err, "W-ORDER"));
  CHECK(contains(unordered.err, "robot_plans/packages.lisp:2"));
}

TEST_CASE("a scenario names a plan folder or a list of files; all of them count as its inputs") {
  const FolderFixture cli;
  cli.write("list.yaml",
            "include: scenario.yaml\nplan: [robot_plans/packages.lisp, robot_plans/z_plans.lisp, "
            "robot_plans/a_main.lisp]\n");
  for (const char* scenario : {"whole.yaml", "list.yaml"}) {
    CAPTURE(scenario);
    const auto checked = cli.parallax({"check", scenario});
    CAPTURE(checked.err);
    CHECK(checked.code == 0);
    const auto run = cli.parallax({"run", scenario, "--max-runs", "1", "--out", "r"});
    CAPTURE(run.err);
    REQUIRE((run.code == 0 || run.code == 1 || run.code == 4));
    CHECK(contains(cli.read("r/journal.ndjson"), "z_plans.lisp:"));
    CHECK_FALSE(contains(cli.parallax({"replay", "r", "--sample", "1.1"}).err, "now it is "));
    const auto plan = cli.read("robot_plans/z_plans.lisp");
    cli.write("robot_plans/z_plans.lisp", plan + "; changed\n");
    std::filesystem::remove(cli.folder() / "r/inputs.json");  // else the kept texts are repeated
    const auto replayed = cli.parallax({"replay", "r", "--sample", "1.1"});
    CHECK(replayed.code != 0);
    CHECK(contains(replayed.err, "now it is "));
    cli.write("robot_plans/z_plans.lisp", plan);
    std::filesystem::remove_all(cli.folder() / "r");
  }
}

TEST_CASE("no path of a scenario's plan folder leaves the scenario's folder") {
  const FolderFixture cli;
  std::filesystem::create_directory(cli.folder() / "inner");
  for (const auto& entry : std::filesystem::directory_iterator(cli.folder())) {
    if (entry.path().filename() != "inner") {
      std::filesystem::rename(entry.path(), cli.folder() / "inner" / entry.path().filename());
    }
  }
  cli.write("secret.lisp", "(hunter2");
  SUBCASE("by the scenario") {
    cli.write("inner/whole.yaml", "include: scenario.yaml\nplan: [robot_plans, ../secret.lisp]\n");
  }
  SUBCASE("by the system definition") {
    cli.write("inner/robot_plans/robot-plans.asd",
              "(defsystem p :components ((:file \"../../secret\")))");
  }
  SUBCASE("by a link") {
    cli.write("inner/robot_plans/robot-plans.asd", "(defsystem p :components ((:file \"x\")))");
    std::filesystem::create_symlink("../../secret.lisp", cli.folder() / "inner/robot_plans/x.lisp");
  }
  const auto refused = cli.parallax({"check", "inner/whole.yaml"});
  CAPTURE(refused.err);
  CHECK(refused.code == 3);
  CHECK(contains(refused.err, "E1016"));
  CHECK_FALSE(contains(refused.err, "hunter2"));
}

TEST_CASE("no output replaces a file of a plan folder") {
  const FolderFixture cli;
  const auto refused = cli.parallax({"compile", "whole.yaml", "-o", "robot_plans/z_plans.lisp"});
  CAPTURE(refused.err);
  CHECK(contains(refused.err, "E0011"));
  CHECK(contains(cli.read("robot_plans/z_plans.lisp"), "fetch-box"));
}

}  // namespace
}  // namespace parallax::test
