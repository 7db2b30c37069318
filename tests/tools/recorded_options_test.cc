// Options of a run, as the header of its journal records them: wrong values are reported at their
// line, whoever reads it, and rounds of repair use the same options.

#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/tools/cli_json.h"
#include "tests/tools/two_models.h"

namespace parallax::test {
namespace {

using Json = nlohmann::ordered_json;

/// The journal with another header.
void write_header(const CliFixture& cli, const std::string& journal, const Json& header,
                  const std::string& folder) {
  cli.write(folder + "/journal.ndjson", header.dump() + journal.substr(journal.find('\n')));
}

TEST_CASE("a header with wrong options is refused by all that read it, at its line") {
  const TwoModels cli;
  json_of(cli, {"run", "two/unparks.yaml", "--out", "out"}, 1);
  const auto journal = cli.read("out/journal.ndjson");
  const auto header = Json::parse(journal.substr(0, journal.find('\n')));
  const std::vector<std::pair<std::string, Json>> wrong = {
      {"/criterion", 3},
      {"/criterion", nullptr},
      {"/criterion/kind", "sometimes"},
      {"/criterion/epsilon", 7},
      {"/criterion/epsilon", -0.5},
      {"/criterion/epsilon", 1e300},
      {"/criterion/epsilon", "small"},
      {"/criterion/confidence", Json::array()},
      {"/criterion/paper", 1},
      {"/match", Json::array()},
      {"/match", "neither"},
      {"/compare", 0},
      {"/execution", nullptr},
      {"/keep_going", "yes"},
      {"/limits", "none"},
      {"/limits/max_traces", -1},
      {"/limits/max_traces", 1e40},
      {"", 5},
  };
  for (const auto& [place, value] : wrong) {
    CAPTURE(place);
    CAPTURE(value.dump());
    auto changed = header;
    changed["options"][Json::json_pointer(place)] = value;
    if (place.empty()) changed["options"] = value;
    write_header(cli, journal, changed, "out");
    const std::vector<std::vector<std::string>> commands = {
        {"explain", "out"},
        {"replay", "out"},
        {"coverage", "out"},
        {"monitor", "two/unparks.yaml", "out"},
        {"repair", "out"},
        {"repair", "out", "--loop", "--out", "fixed"},
        {"run", "two/unparks.yaml", "--out", "out", "--resume"}};
    for (const auto& command : commands) {
      CAPTURE(command.front());
      const auto result = cli.parallax(command);
      CAPTURE(result.err);
      CHECK(result.code == 3);
      CHECK(result.err.starts_with("out/journal.ndjson:1:1-"));
      CHECK(result.err.find(": error[E7103]: this line is not one of the journal: `options") !=
            std::string::npos);
    }
    // A page shows the parts that are there, and names those that are not.
    CHECK(cli.parallax({"report", "out", "-o", "page.html"}).code <= 3);
  }
}

TEST_CASE("rounds of repair keep what the run was asked for") {
  const std::vector<std::vector<std::string>> options = {
      {"--split-initial"},
      {"--keep-going"},
      {"--until-covered"},
      {"--max-runs", "120", "--epsilon", "0.04"},
      {"--criterion", "paper"},
      {"--match", "trace"},
      {"--compare", "final"},
      {"--hits", "all"},
      {"--execution", "closed-loop", "--starts", "guided"},
  };
  for (const auto& given : options) {
    CAPTURE(given.front());
    const TwoModels cli;
    // The last state is another one, too.
    cli.world("load opens.e\n\n[drawer,time] Initiates(Park(),Open(drawer),time).\n");
    std::vector<std::string> run = {"run", "two/own.yaml", "--out", "out"};
    run.insert(run.end(), given.begin(), given.end());
    cli.parallax(run);
    cli.parallax({"repair", "out", "--loop", "--out", "fixed", "--runs", "0"});
    const auto header = [&](const std::string& folder) {
      const auto journal = cli.read(folder + "/journal.ndjson");
      return Json::parse(journal.substr(0, journal.find('\n')));
    };
    REQUIRE(std::filesystem::exists(cli.folder() / "fixed/run-1/journal.ndjson"));
    CHECK(header("fixed/run-1").at("options") == header("out").at("options"));
    CHECK(header("fixed/run-1").value("max_runs", 0) == header("out").value("max_runs", 0));
    if (given.front() == "--max-runs") CHECK(header("out").at("max_runs") == 120);
    if (given.front() == "--split-initial") {
      CHECK(header("out").at("options").at("split_initial") == true);
    }
  }
}

TEST_CASE("a run of every initial state is explained with further runs of its own traces") {
  const TwoModels cli;
  // Half of the starts go wrong, for a reason that the model has no word for.
  cli.world("load opens.e\n\n[drawer,time] Terminates(OpenDrawer(drawer),Parked(),time).\n");
  json_of(cli, {"run", "two/own.yaml", "--out", "out", "--split-initial"}, 1);
  const auto told = json_of(cli, {"explain", "out"}, 1);
  CHECK(told.at("evidence").at("further") > 0);
}

TEST_CASE(
    "a lost execution has its place among those that rates count, and shows no cause or none") {
  const TwoModels cli;
  cli.write("two/own.yaml",
            "include: common.yaml\nsimulator: {model: sticks.e}\nmodel: [opens.e, start.e]\n");
  const std::vector<std::string> run = {
      "run", "two/own.yaml", "--execution", "closed-loop", "--keep-going", "--out", "out"};
  const auto before = json_of(cli, run, 1).at("traces").at(0);
  REQUIRE(before.at("causes_runs") == 90);
  // One that is on record as lost, and went wrong before.
  std::string text;
  bool failed = false;
  std::istringstream lines(cli.read("out/journal.ndjson"));
  for (std::string line; std::getline(lines, line);) {
    auto record = Json::parse(line);
    if (record.value("sample", 0) == 5 && record.at("phase") == "confirm") continue;
    if (record.value("sample", 0) == 5) {
      failed = record.at("end") == "failed";
      record["status"] = "lost";
      record["reason"] = "gone";
      record["digest"] = "";
      for (const auto* name : {"observations", "outcomes", "path"}) record[name] = Json::array();
    }
    text += record.dump() + "\n";
  }
  cli.write("out/journal.ndjson", text);
  auto again = run;
  again.emplace_back("--resume");
  const auto after = json_of(cli, again, 1).at("traces").at(0);
  CHECK(after.at("lost") == 1);
  CHECK(after.at("causes_runs") == 89);
  const int count = before.at("causes").at(0).at("count");
  CHECK(after.at("causes").at(0).at("count") == count - (failed ? 1 : 0));
}

}  // namespace
}  // namespace parallax::test
