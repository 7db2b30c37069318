// A world that is a model, and reads files of the repaired model, stays as it was.

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/tools/cli_json.h"
#include "tests/tools/two_models.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

/// The world is the model's own files and one effect more; a wrong repair of them would be one of
/// the world, too.
struct SharedFiles : CliFixture {
  explicit SharedFiles(const std::string& yaml =
                           "model: [model.e, start.e]\n"
                           "simulator: {model: world/truth.e}\n") {
    write("domain.e",
          "fluent Open()\nfluent Lit()\n\nevent Pull()\nevent Wait()\n\n"
          "[time] Initiates(Pull(),Open(),time).\n");
    fs::create_directories(folder() / "world");
    write("model.e", "load domain.e\n");
    write("world/truth.e", "load ../domain.e\n\n[time] Initiates(Pull(),Lit(),time).\n");
    write("start.e", "!HoldsAt(Open(),0).\n!HoldsAt(Lit(),0).\n");
    write("pull.lisp",
          "(def-cram-function pull ()\n  (perform (an action (type pulling)))\n"
          "  (perform (an action (type waiting))))\n(pull)\n");
    write("robot.bind",
          "action pulling () -> Pull()  ok: Open() | !Open() @t+1 "
          "else manipulation-goal-not-reached\n"
          "action waiting () -> Wait()  ok: Open() | !Open() @t+1 "
          "else manipulation-goal-not-reached\n");
    write("pull.yaml", yaml +
                           "plan: pull.lisp\nbind: robot.bind\nhorizon: 2\n"
                           "constraints: \"Happens(Wait(),time-1)\"\n");
  }
};

bool has_line(const std::string& text, const std::string& line) {
  return ("\n" + text).find("\n" + line + "\n") != std::string::npos;
}

TEST_CASE("rounds run in the world as it was, though it reads the files that are repaired") {
  for (const std::string simulator :
       {"simulator: {model: world/truth.e}\n", "simulator: {model: \"world/truth.e\"}\n",
        "simulator:\n  model:\n    - domain.e\n    - world/truth.e\n"}) {
    CAPTURE(simulator);
    const SharedFiles cli("model: [model.e, start.e]\n" + simulator);
    json_of(cli, {"run", "pull.yaml", "--out", "out"}, 1);
    const auto before = files_below(cli.folder());
    const auto report = json_of(cli, {"repair", "out", "--loop", "--out", "fixed"});
    CHECK(report.at("end") == "clean");
    // The files that the world read are there a second time, unchanged.
    int frozen = 0;
    for (const auto& [path, text] : files_below(cli.folder() / "fixed")) {
      if (path.find("world-of-the-run") == std::string::npos) continue;
      ++frozen;
      CHECK(text == cli.read(path.substr(path.find("world-of-the-run/") + 17)));
    }
    CHECK(frozen == 2);
    for (const auto& [path, text] : before) CHECK(cli.read(path) == text);
    // The copies are a scenario by themselves, with the world as it was.
    CHECK(json_of(cli, {"run", "fixed/files/pull.yaml", "--out", "again"}).at("verdict") ==
          "no-discrepancy");
    CHECK(cli.parallax({"replay", "fixed/run-1"}).code == 0);
    // The patch changes no line about the world.
    CHECK(report.at("patch").get<std::string>().find("pull.yaml") == std::string::npos);
  }
}

TEST_CASE("a world that is the very model cannot prove its own repair") {
  // The folder was run in a world that opened the lamp; the model equals the world as it is now.
  const SharedFiles cli("model: [domain.e, start.e]\nsimulator: {model: [world/truth.e]}\n");
  json_of(cli, {"run", "pull.yaml", "--out", "out"}, 1);
  const auto report = json_of(cli, {"repair", "out", "--loop", "--out", "fixed"});
  CHECK(report.at("end") == "clean");
  // A wrong change of a file that both read shows: in the copies, by hand, outside of the loop.
  const auto copy = cli.read("fixed/files/domain.e");
  cli.replace("fixed/files/domain.e", "Initiates(Pull(),Open(),time)",
              "Terminates(Pull(),Open(),time)");
  CHECK(copy != cli.read("fixed/files/domain.e"));
  CHECK(cli.parallax({"run", "fixed/files/pull.yaml", "--out", "wrong"}).code == 1);
}

TEST_CASE("who applies a change to what the world reads, too, is told so") {
  const SharedFiles cli("model: [domain.e, start.e]\nsimulator: {model: world/truth.e}\n");
  json_of(cli, {"run", "pull.yaml", "--out", "out"}, 1);
  const auto report = json_of(cli, {"repair", "out", "--runs", "0"}, 1);
  REQUIRE(!report.at("proposals").empty());
  CHECK(report.at("proposals").at(0).at("read_by_world") == nlohmann::json::array({"domain.e"}));
  const auto text = cli.parallax({"repair", "out", "--runs", "0"});
  CHECK(has_line(text.out,
                 "   The world reads domain.e, too: applied, this changes the world with the "
                 "model."));
  const auto applied = cli.parallax({"repair", "out", "--apply", "1"});
  CHECK(applied.code == 0);
  CHECK(applied.err.find("the world reads domain.e, too, and was changed with the model") !=
        std::string::npos);

  // A file that only the model reads is no matter.
  const SharedFiles other;
  json_of(other, {"run", "pull.yaml", "--out", "out"}, 1);
  const auto alone = json_of(other, {"repair", "out", "--runs", "0"}, 1);
  const auto first = alone.at("proposals").at(0);
  CHECK(first.at("read_by_world").empty() ==
        (first.at("patch").get<std::string>().find("domain.e") == std::string::npos));
}

}  // namespace
}  // namespace parallax::test
