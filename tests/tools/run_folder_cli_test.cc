// Run folders as real processes read them back: from any current folder, moved, damaged.

#include <functional>
#include <sstream>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A run with a discrepancy, in `r`. It has kept no texts, as one of an older version.
class RunFixture : public CliFixture {
 public:
  RunFixture() {
    const auto run = parallax({"run", "wrong_model.yaml", "--out", "r", "--max-runs", "20"});
    REQUIRE(run.code == 1);
    REQUIRE(fs::remove(folder() / "r/inputs.json"));
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
    // Another scenario, and a file that does not exist.
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

/// Changes line `line` of the journal in `r`, from 0.
void edit_line(const CliFixture& cli, std::size_t line,
               const std::function<void(nlohmann::ordered_json&)>& edit) {
  std::istringstream text(cli.read("r/journal.ndjson"));
  std::string out, each;
  for (std::size_t i = 0; std::getline(text, each); ++i) {
    auto json = nlohmann::ordered_json::parse(each);
    if (i == line) edit(json);
    out += json.dump() + "\n";
  }
  cli.write("r/journal.ndjson", out);
}

TEST_CASE("a journal that was changed is not believed") {
  const RunFixture cli;
  using Json = nlohmann::ordered_json;
  constexpr std::size_t kHeader = 0, kTrace = 1, kFirst = 2, kLast = 3;
  REQUIRE(Json::parse(cli.read("r/report.json"))["simulations"] == 1);
  std::string why, place = "r/journal.ndjson:2:1-";
  const auto first_and_last = [&](const std::function<void(Json&)>& edit) {
    edit_line(cli, kFirst, edit);
    edit_line(cli, kLast, edit);
    place = "r/journal.ndjson:3:1-";
  };
  SUBCASE("a start that was not drawn") {
    first_and_last([](Json& record) { record["initial"]["box.x"] = 1.5; });
    why = "its start is not that of its number";
  }
  SUBCASE("a seed that was not drawn") {
    first_and_last([](Json& record) { record["seed"] = 12345; });
    why = "its seed is not that of its number";
  }
  SUBCASE("another number") {
    edit_line(cli, kTrace, [](Json& trace) { trace["key"] = "Go(r2);"; });
    why = "`Go(r2);` is not its key";
  }
  SUBCASE("another seed of the run") {
    edit_line(cli, kHeader, [](Json& header) { header["seed"] = 2; });
    why = "its start is not that of its number";
    place = "r/journal.ndjson:3:1-";
  }
  SUBCASE("a state that the model does not come to") {
    edit_line(cli, kTrace, [](Json& trace) { trace["holds"][2] = {"BoxIn(r1)", "RobotIn(r1)"}; });
    why = "the model has no trace that goes so up to timepoint 2";
  }
  SUBCASE("a fluent that the model has not") {
    edit_line(cli, kTrace, [](Json& trace) { trace["holds"][2] = {"Flying()"}; });
    why = "it names what the model has not";
  }
  SUBCASE("another controller") {
    edit_line(cli, kTrace, [](Json& trace) { trace["events"][0]["controller"] = "placing"; });
    why = "`placing` is not what the scenario does for `PickUp()`";
  }
  SUBCASE("what was observed, beside its digest") {
    edit_line(cli, kFirst, [](Json& record) { record["observations"].back()["box.x"] = 0.25; });
    why = "it differs from the simulation that it repeats, but for the digest";
    place = "r/journal.ndjson:4:1-";
  }
  SUBCASE("the digest") {
    edit_line(cli, kFirst, [](Json& record) { record["digest"] = "0"; });
    why = "its digest is not that of its last observation";
    place = "r/journal.ndjson:3:1-";
  }
  SUBCASE("two simulations of one number") {
    edit_line(cli, kLast, [](Json& record) { record["phase"] = "certify"; });
    why = "this simulation stands there twice";
    place = "r/journal.ndjson:4:1-";
  }
  for (const std::string command : {"replay", "explain", "draw"}) {
    CAPTURE(command);
    const auto result = cli.parallax({command, "r"});
    CAPTURE(result.err);
    CHECK(result.code == 3);
    CHECK(result.out.empty());
    CHECK(holds(result.err, place));
    CHECK(holds(result.err, "error[E7103]: this line is not one of the journal: " + why));
  }
  const auto resumed =
      cli.parallax({"run", "wrong_model.yaml", "--out", "r", "--max-runs", "20", "--resume"});
  CAPTURE(resumed.err);
  CHECK(resumed.code == 3);
  CHECK(holds(resumed.err, "r/journal.ndjson:"));
}

TEST_CASE("explain holds the report against the journal") {
  const RunFixture cli;
  auto report = nlohmann::ordered_json::parse(cli.read("r/report.json"));
  auto& seen = report["discrepancies"][0]["first"][0]["observed"];
  seen = !seen.get<bool>();
  cli.write("r/report.json", report.dump());
  const auto result = cli.parallax({"explain", "r"});
  CHECK(result.code == 3);
  CHECK(holds(result.err, "is not the discrepancy that report.json tells of"));
}

TEST_CASE("a run replaces no report that is none of its own") {
  const CliFixture cli;
  fs::create_directory(cli.folder() / "d");
  for (const std::string name : {"report.txt", "report.json"}) {
    cli.write("d/" + name, "mine");
    for (const bool resume : {false, true}) {
      std::vector<std::string> run = {"run", "scenario.yaml", "--out", "d", "--max-runs", "1"};
      if (resume) run.emplace_back("--resume");
      const auto result = cli.parallax(run);
      CHECK(result.code == 2);
      CHECK(holds(result.err, "d/" + name + ": error[E0005]: cannot write the file: it is there"));
    }
    CHECK(cli.read("d/" + name) == "mine");
    CHECK_FALSE(fs::exists(cli.folder() / "d/journal.ndjson"));
    fs::remove(cli.folder() / "d" / name);
  }
}

TEST_CASE("a run that lacks memory names the limit") {
  const CliFixture cli;
  for (const std::string command : {"run", "rates", "suite"}) {
    const auto result = cli.parallax({command, "scenario.yaml", "--memory-limit", "16"});
    CAPTURE(result.err);
    if (result.code != 4) continue;  // it was enough on this machine
    CHECK(holds(result.err, "error[E0008]: the limit --memory-limit 16 ended the run"));
  }
}

TEST_CASE("a copied run says which scenario is read") {
  const RunFixture cli;
  const auto copy = cli.folder() / "copy";
  fs::create_directory(copy);
  fs::copy(cli.folder() / "r", copy / "r");
  for (const auto& entry : fs::directory_iterator(cli.folder())) {
    if (entry.is_regular_file()) fs::copy(entry.path(), copy / entry.path().filename());
  }
  const auto said = "the scenario is " + (cli.folder() / "wrong_model.yaml").string();
  for (const std::string command : {"replay", "explain", "draw"}) {
    CHECK(holds(cli.from(copy, {command, "r"}).err, said));
    CHECK_FALSE(holds(cli.parallax({command, "r"}).err, "the scenario is"));
    CHECK_FALSE(holds(cli.from(copy, {command, "r", "--scenario", "wrong_model.yaml"}).err,
                      "the scenario is"));
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
