// The folder at which the names in a patch begin: git applies it there, wherever `repair` was
// called.

#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/tools/cli_json.h"
#include "tests/tools/two_models.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

const std::string kEffect = "Terminates(OpenDrawer(drawer),Parked(),time)";

ProcessOptions in(const fs::path& folder) {
  ProcessOptions options;
  options.folder = folder.string();
  return options;
}

/// A run of the model that forgets an effect, in a folder with a git repository in it.
struct Forgets : TwoModels {
  Forgets() {
    REQUIRE(run_process({"git", "init", "-q", "."}, in(folder())).code == 0);
    json_of(*this, {"run", "two/unparks.yaml", "--out", "out"}, 1);
    fs::create_directories(folder() / "two" / "deep");
    fs::create_directories(folder() / "beside it");
  }
  nlohmann::json first_from(const fs::path& from, const fs::path& run) const {
    const auto result = parallax({"repair", run.string(), "--limit", "1", "--json"}, in(from));
    CAPTURE(result.err);
    CHECK(result.code == 1);
    return nlohmann::json::parse(result.out).at("proposals").at(0);
  }
  /// It is a change of the file with this name there, and git makes it.
  void check_applies(const std::string& patch, const fs::path& where,
                     const std::string& name) const {
    CAPTURE(patch);
    CHECK(patch.starts_with("--- a/" + name + "\n+++ b/" + name + "\n@@"));
    const auto before = read("two/opens.e");
    write("p.diff", patch);
    const auto applied = run_process({"git", "apply", (folder() / "p.diff").string()}, in(where));
    CHECK_MESSAGE(applied.code == 0, applied.err);
    CHECK(read("two/opens.e") == before + "[drawer,time] " + kEffect + ".\n");
    write("two/opens.e", before);
  }
};

TEST_CASE("a patch begins in the current folder, if the files lie below it") {
  const Forgets cli;
  const auto here = cli.first_from(cli.folder(), "out");
  CHECK(here.at("patch_folder") == ".");
  cli.check_applies(here.at("patch"), cli.folder(), "two/opens.e");
  // However the folders are called.
  const auto two = cli.folder() / "two";
  for (const auto& run : std::vector<fs::path>{"../out", cli.folder() / "out", "../two/../out"}) {
    CAPTURE(run);
    const auto below = cli.first_from(two, run);
    CHECK(below.at("patch_folder") == ".");
    cli.check_applies(below.at("patch"), two, "opens.e");
  }
  fs::create_directory_symlink(two, cli.folder() / "link");
  const auto linked = cli.first_from(cli.folder() / "link", cli.folder() / "out");
  cli.check_applies(linked.at("patch"), two, "opens.e");
  const auto text = cli.parallax({"repair", "out", "--limit", "1"}).out;
  CHECK(text.find("The patch begins at") == std::string::npos);
}

TEST_CASE("else at the top of the repository that has them, which is said") {
  const Forgets cli;
  for (const std::string from : {"two/deep", "beside it", "out"}) {
    CAPTURE(from);
    const auto run = cli.folder() / "out";
    const auto top = from == "two/deep" ? "../.." : "..";
    const auto first = cli.first_from(cli.folder() / from, run);
    CHECK(first.at("patch_folder") == top);
    cli.check_applies(first.at("patch"), cli.folder() / from / top, "two/opens.e");
    const auto text =
        cli.parallax({"repair", run.string(), "--limit", "1"}, in(cli.folder() / from)).out;
    CHECK(text.find("The patch begins at " + std::string(top) + ": `git -C ") != std::string::npos);
  }
}

TEST_CASE("the patch of rounds begins there as well") {
  const Forgets cli;
  const auto from = cli.folder() / "beside it";
  const auto result =
      cli.parallax({"repair", "../out", "--loop", "--out", "rounds", "--json"}, in(from));
  CAPTURE(result.err);
  const auto report = nlohmann::json::parse(result.out);
  CHECK(report.at("end") == "clean");
  CHECK(report.at("patch_folder") == "..");
  CHECK(cli.read("beside it/rounds/repair.patch") == report.at("patch").get<std::string>());
  cli.check_applies(report.at("patch"), cli.folder(), "two/opens.e");
  CHECK(cli.read("beside it/rounds/rounds.txt").find("The patch begins at ..: ") !=
        std::string::npos);
}

TEST_CASE("files that lie in no repository and elsewhere are named from the root") {
  const TwoModels cli;
  json_of(cli, {"run", "two/unparks.yaml", "--out", "out"}, 1);
  fs::create_directories(cli.folder() / "beside");
  const auto result =
      cli.parallax({"repair", "../out", "--limit", "1", "--json"}, in(cli.folder() / "beside"));
  const auto first = nlohmann::json::parse(result.out).at("proposals").at(0);
  CHECK(first.at("patch_folder") == "/");
  const auto name = fs::canonical(cli.folder() / "two" / "opens.e").string().substr(1);
  CHECK(first.at("patch").get<std::string>().starts_with("--- a/" + name + "\n"));
  CHECK(first.at("patch").get<std::string>().find("..") == std::string::npos);
}

TEST_CASE("a name with a blank in it") {
  const TwoModels cli;
  fs::rename(cli.folder() / "two", cli.folder() / "two of them");
  json_of(cli, {"run", "two of them/unparks.yaml", "--out", "out"}, 1);
  const auto first = json_of(cli, {"repair", "out"}, 1).at("proposals").at(0);
  cli.write("p.diff", first.at("patch").get<std::string>());
  const auto applied = run_process({"git", "apply", "p.diff"}, in(cli.folder()));
  CHECK_MESSAGE(applied.code == 0, applied.err);
  CHECK(cli.read("two of them/opens.e").find(kEffect) != std::string::npos);
}

}  // namespace
}  // namespace parallax::test
