// Run folders as real processes read them back: from any current folder, moved, damaged.

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A run with a discrepancy, in `r`.
class RunFixture : public CliFixture {
 public:
  RunFixture() {
    const auto run = parallax({"run", "wrong_model.yaml", "--out", "r", "--max-runs", "20"});
    REQUIRE(run.code == 1);
  }
  ProcessResult from(const fs::path& folder, const std::vector<std::string>& arguments) const {
    ProcessOptions options;
    options.folder = folder.string();
    return parallax(arguments, options);
  }
  void spoil(const std::string& from, const std::string& to) const {
    auto text = read("r/journal.ndjson");
    const auto at = text.find(from);
    REQUIRE(at != std::string::npos);
    write("r/journal.ndjson", text.replace(at, from.size(), to));
  }
};

TEST_CASE("a run folder works from any current folder") {
  const RunFixture cli;
  const auto folder = (cli.folder() / "r").string();
  CHECK(cli.from("/", {"replay", folder}).code == 0);
  CHECK(cli.from("/", {"explain", folder}).code == 1);
  CHECK(cli.from("/", {"draw", folder}).code == 0);
  CHECK(cli.from(cli.folder() / "r", {"replay", "."}).code == 0);

  SUBCASE("a journal without a start folder is read as it was before") {
    cli.spoil("\"start_folder\":\"" + cli.folder().string() + "\",", "");
    CHECK(cli.parallax({"replay", "r"}).code == 0);
    const auto lost = cli.from("/", {"replay", folder});
    CHECK(lost.code == 3);
    CHECK(holds(lost.err, "there is no scenario `wrong_model.yaml`"));
    CHECK(holds(lost.err, "--scenario"));
  }
}

TEST_CASE("--scenario says where the scenario of a run lies by now") {
  const RunFixture cli;
  fs::create_directory(cli.folder() / "elsewhere");
  for (const auto& entry : fs::directory_iterator(cli.folder())) {
    if (entry.is_regular_file()) {
      fs::rename(entry.path(), cli.folder() / "elsewhere" / entry.path().filename());
    }
  }
  const std::string there = "elsewhere/wrong_model.yaml";
  for (const std::string command : {"replay", "explain", "draw"}) {
    CAPTURE(command);
    CHECK(cli.parallax({command, "r"}).code == 3);
    CHECK(cli.parallax({command, "r", "--scenario", there}).code == (command == "explain" ? 1 : 0));
    // Another scenario, and one that is none.
    CHECK(cli.parallax({command, "r", "--scenario", "elsewhere/edge.yaml"}).code == 3);
    CHECK(cli.parallax({command, "r", "--scenario", "nowhere.yaml"}).code == 2);
  }
  // The whole project was moved: the paths start where one stands.
  const RunFixture other;
  const auto moved = cli.folder() / "moved";
  fs::copy(other.folder(), moved, fs::copy_options::recursive);
  fs::remove_all(other.folder());
  CHECK(cli.from(moved, {"replay", "r"}).code == 0);
}

TEST_CASE("--scenario and --sample belong to run folders") {
  const RunFixture cli;
  CHECK(cli.parallax({"explain", "domain.e", "--scenario", "edge.yaml"}).code == 2);
  CHECK(cli.parallax({"explain", "domain.e", "--sample", "1.1"}).code == 2);
  CHECK(cli.parallax({"draw", "edge.yaml", "--scenario", "edge.yaml"}).code == 2);
}

TEST_CASE("a damaged journal is located by every command that reads it") {
  const RunFixture cli;
  std::string place = "r/journal.ndjson:2:1-";
  SUBCASE("a line cut short") { cli.spoil("{\"trace\":1,", "{\"trace\":1\n,"); }
  SUBCASE("a negative count") {
    cli.spoil("\"retries\":0", "\"retries\":-1");
    place = "r/journal.ndjson:3:1-";
  }
  SUBCASE("a negative number of rejected starts") {
    cli.spoil("\"rejected\":0", "\"rejected\":-3");
    place = "r/journal.ndjson:3:1-";
  }
  SUBCASE("a negative number of draws") {
    cli.spoil("\"attempt\":0", "\"attempt\":-1");
    place = "r/journal.ndjson:3:1-";
  }
  SUBCASE("time that runs backwards") {
    cli.spoil("\"sim_time_s\":", "\"sim_time_s\":-1");
    place = "r/journal.ndjson:3:1-";
  }
  SUBCASE("a trace of number 0") { cli.spoil("{\"trace\":1,", "{\"trace\":0,"); }
  SUBCASE("a timepoint too few") { cli.spoil("\"holds\":[", "\"holds\":[[],"); }
  for (const std::string command : {"replay", "explain", "draw"}) {
    CAPTURE(command);
    const auto result = cli.parallax({command, "r"});
    CAPTURE(result.err);
    CHECK(result.code == 3);
    CHECK(holds(result.err, place));
    CHECK(holds(result.err, "E7103"));
  }
}

TEST_CASE("a report that is none is refused by explain") {
  const RunFixture cli;
  for (const auto* text : {"", "[]", "{\"discrepancies\":3}", "{\"discrepancies\":[3]}",
                           "{\"discrepancies\":[{\"trace\":\"x\"}]}",
                           "{\"discrepancies\":[{\"trace\":1,\"sample\":1,\"first_divergence\":1,"
                           "\"first\":[{\"fluent\":1}]}]}"}) {
    CAPTURE(text);
    cli.write("r/report.json", text);
    const auto result = cli.parallax({"explain", "r"});
    CHECK(result.code == 2);
    CHECK(holds(result.err, "no report of a run"));
  }
}

TEST_CASE("a simulation that is not there is answered with those that are") {
  const RunFixture cli;
  const auto replay = cli.parallax({"replay", "r", "--sample", "7.1"});
  CHECK(replay.code == 2);
  CHECK(holds(replay.err, "no simulation 7.1"));
  CHECK(holds(replay.err, "trace 1 has simulations from 1.1 to 1."));
  const auto explain = cli.parallax({"explain", "r", "--sample", "7.1"});
  CHECK(explain.code == 2);
  CHECK(holds(explain.err, "it found discrepancies in 1."));
}

TEST_CASE("a recorded scenario that is not that of the run is not quoted") {
  const RunFixture cli;
  cli.write("secret.yaml", "password: [hunter2\n");
  cli.spoil("\"scenario\":\"wrong_model.yaml\"", "\"scenario\":\"secret.yaml\"");
  for (const std::string command : {"replay", "explain", "draw"}) {
    CAPTURE(command);
    const auto result = cli.parallax({command, "r"});
    CHECK(result.code == 3);
    CHECK(holds(result.err, "E7113"));
    CHECK(holds(result.err, "parallax check"));
    CHECK_FALSE(holds(result.err, "hunter2"));
  }
}

}  // namespace
}  // namespace parallax::test
