// `parallax doctor`: tries the parts that work, and says what to do about those that do not.

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

/// `env ASSIGNMENTS... parallax doctor --json` in the fixture's folder.
struct Answer {
  int code = -1;
  nlohmann::json document;
};
Answer doctor_with(const CliFixture& cli, const std::vector<std::string>& assignments) {
  std::vector<std::string> command = {"/usr/bin/env"};
  command.insert(command.end(), assignments.begin(), assignments.end());
  command.insert(command.end(), {PARALLAX_PROGRAM, "doctor", "--json"});
  ProcessOptions options;
  options.folder = cli.folder().string();
  const auto result = run_process(command, options);
  CAPTURE(result.err);
  REQUIRE(nlohmann::json::accept(result.out));
  return {result.code, nlohmann::json::parse(result.out)};
}

nlohmann::json check_of(const nlohmann::json& document, const std::string& name) {
  for (const auto& check : document.at("checks")) {
    if (check.at("name") == name) return check;
  }
  FAIL("no check " << name);
  return {};
}

TEST_CASE("where all is well, it says so, and leaves nothing behind") {
  const CliFixture cli;
  std::filesystem::create_directory(cli.folder() / "tmp");
  const auto answer = doctor_with(cli, {"TMPDIR=" + (cli.folder() / "tmp").string()});
  CHECK(answer.code == 0);
  CHECK(answer.document.at("failures") == 0);
  CHECK(answer.document.at("cores") >= 1);
  CHECK_FALSE(answer.document.at("build").at("compiler").get<std::string>().empty());
  for (const auto* name : {"CaDiCaL", "ODE", "Eigen", "GMP", "yaml-cpp", "fmt"}) {
    CAPTURE(name);
    const auto version = answer.document.at("libraries").at(name).get<std::string>();
    CHECK(version.find_first_of("0123456789") == 0);
  }
  for (const auto* name : {"folder", "solver", "simulator"}) {
    CAPTURE(name);
    const auto check = check_of(answer.document, name);
    CHECK(check.at("health") == "works");
    CHECK(check.at("needed") == true);
    CHECK_FALSE(check.contains("remedy"));
  }
  for (const auto* name : {"MuJoCo", "Bullet", "SDF", "URDF", "MJCF", "meshes", "git", "python3"}) {
    CAPTURE(name);
    const auto check = check_of(answer.document, name);
    CHECK(check.at("needed") == false);
    CHECK(check.at("health") != "broken");
    if (check.at("health") == "absent") CHECK(check.contains("package"));
  }
  CHECK(std::filesystem::is_empty(cli.folder() / "tmp"));
  const auto text = cli.parallax({"doctor"});
  CHECK(text.code == 0);
  CHECK(text.err.empty());
  CHECK(text.out.starts_with("parallax "));
  CHECK(text.out.ends_with("\neverything that is needed works\n"));
}

TEST_CASE("without a folder for temporary files nothing is tried there, and it says what to do") {
  const CliFixture cli;
  const auto answer = doctor_with(cli, {"TMPDIR=" + (cli.folder() / "none").string()});
  CHECK(answer.code == 1);
  CHECK(answer.document.at("failures") == 3);
  CHECK(check_of(answer.document, "folder").at("health") == "broken");
  CHECK(check_of(answer.document, "folder").at("remedy").get<std::string>().find("TMPDIR") !=
        std::string::npos);
  CHECK(check_of(answer.document, "solver").at("health") == "not-tried");
  CHECK(check_of(answer.document, "simulator").at("health") == "not-tried");
}

TEST_CASE("helper programs that are not there are named with their package, and are no failure") {
  const CliFixture cli;
  std::filesystem::create_directory(cli.folder() / "bin");
  const auto answer = doctor_with(cli, {"PATH=" + (cli.folder() / "bin").string()});
  CHECK(answer.code == 0);
  for (const auto* name : {"git", "python3"}) {
    CAPTURE(name);
    const auto check = check_of(answer.document, name);
    CHECK(check.at("health") == "absent");
    CHECK(check.at("package") == name);
  }
}

TEST_CASE("a helper program that is there and fails is told with what it says") {
  const CliFixture cli;
  std::filesystem::create_directory(cli.folder() / "bin");
  cli.write("bin/git", "#!/bin/sh\necho 'git: a library is missing' >&2\nexit 127\n");
  ::chmod((cli.folder() / "bin/git").c_str(), 0755);
  const auto answer = doctor_with(cli, {"PATH=" + (cli.folder() / "bin").string()});
  CHECK(answer.code == 1);
  CHECK(answer.document.at("failures") == 1);
  const auto check = check_of(answer.document, "git");
  CHECK(check.at("health") == "broken");
  CHECK(check.at("found").get<std::string>().find("a library is missing") != std::string::npos);
}

TEST_CASE("a time limit ends it as inconclusive") {
  const CliFixture cli;
  CHECK(cli.parallax({"doctor", "--time-limit", "0.001"}).code == 4);
  CHECK(cli.parallax({"doctor", "too", "many"}).code == 2);
}

}  // namespace
}  // namespace parallax::test
