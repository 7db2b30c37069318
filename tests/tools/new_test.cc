// `parallax new`: the project that it creates runs; nothing is replaced.

#include <sys/stat.h>

#include <filesystem>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

TEST_CASE("every scenario that it makes is clean, and runs to a verdict") {
  const CliFixture cli;
  for (const auto* world : {"line", "room", "kitchen"}) {
    CAPTURE(world);
    const std::string name = std::string("my-") + world;
    const auto made = cli.parallax({"new", name, "--world", world});
    CAPTURE(made.err);
    CHECK(made.code == 0);
    CHECK(made.err.empty());
    const auto scenario = name + "/scenario.yaml";
    CHECK(made.out.find("parallax run " + scenario) != std::string::npos);
    const auto checked = cli.parallax({"check", scenario});
    CHECK(checked.code == 0);
    CHECK(checked.err == "no errors\n");
    for (const auto* model : {"domain.e", "start.e"}) {
      CHECK(cli.parallax({"fmt", "--check", name + "/" + model}).code == 0);
    }
    const auto run = json_of(cli, {"run", scenario, "--out", name + "/out", "--jobs", "2"});
    CHECK(run.at("verdict") == "no-discrepancy");
    for (const auto& [file, text] : files_below(cli.folder() / name)) {
      if (file.starts_with("out/")) continue;
      CAPTURE(file);
      CHECK(text.find("@NAME@") == std::string::npos);
    }
  }
}

TEST_CASE("a mistake in what it makes is found: the place at the border of a region") {
  const CliFixture cli;
  CHECK(cli.parallax({"new", "edge"}).code == 0);
  cli.replace("edge/plan.lisp", "(make-3d-vector 0.5 0 0)", "(make-3d-vector 0.99 0 0)");
  CHECK(json_of(cli, {"run", "edge/scenario.yaml", "--out", "out"}, 1).at("verdict") ==
        "discrepancy");
}

TEST_CASE("the same name and options make the same files, and what is there stays") {
  const CliFixture cli;
  const auto made = json_of(cli, {"new", "fetch", "--world", "room", "--robot", "mobile"});
  CHECK(made.at("files").size() == 8);
  CHECK(made.at("robot") == "mobile");
  const auto first = files_below(cli.folder() / "fetch");
  CHECK(first.size() == 8);
  cli.write("fetch/plan.lisp", "mine\n");
  const auto again = cli.parallax({"new", "fetch"});
  CHECK(again.code == 2);
  CHECK(again.err.find("it is there already") != std::string::npos);
  CHECK(cli.read("fetch/plan.lisp") == "mine\n");
  cli.write("file", "mine\n");
  std::filesystem::create_directory(cli.folder() / "empty");
  std::filesystem::create_symlink("nowhere", cli.folder() / "link");
  for (const auto* taken : {"file", "empty", "link"}) {
    CAPTURE(taken);
    CHECK(cli.parallax({"new", taken}).code == 2);
  }
  CHECK(cli.read("file") == "mine\n");
  CHECK(std::filesystem::is_empty(cli.folder() / "empty"));
  CHECK(cli.parallax({"new", "sub/"}).code == 0);
  CHECK(cli.parallax({"new", "sub/fetch", "--world", "room"}).code == 0);
  CHECK(files_below(cli.folder() / "sub/fetch") == first);
}

TEST_CASE("names and places that will not do are one message") {
  const CliFixture cli;
  for (const auto* name :
       {"", ".", "..", "/", "1st", "-x", "a b", "a\nb", "fetch.yaml", "\xff", "a\"b"}) {
    CAPTURE(name);
    const auto result = cli.parallax({"new", "--", name});
    CAPTURE(result.err);
    CHECK(result.code == 2);
    CHECK(result.err.find("error[E0007]") != std::string::npos);
  }
  CHECK(cli.parallax({"new", std::string(65, 'a')}).code == 2);
  CHECK(cli.parallax({"new"}).code == 2);
  CHECK(cli.parallax({"new", "x", "--world", "garage"}).code == 2);
  const auto odd = cli.parallax({"new", "x", "--world", "kitchen", "--robot", "line"});
  CHECK(odd.code == 2);
  CHECK(odd.err.find("there is no world `kitchen` for the robot `line`") != std::string::npos);
  const auto nowhere = cli.parallax({"new", "no/such/folder"});
  CHECK(nowhere.code == 2);
  CHECK(nowhere.err.find("error[E0005]") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(cli.folder() / "x"));
  // Where nobody may write, not even a privileged user.
  const auto closed = cli.parallax({"new", "/proc/self/x"});
  CHECK(closed.code == 2);
  CHECK(closed.err.find("error[E0005]") != std::string::npos);
}

}  // namespace
}  // namespace parallax::test
