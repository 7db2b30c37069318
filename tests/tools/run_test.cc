// The program as users run it, on the scenarios of the two-region world.

#include <doctest/doctest.h>

#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

std::size_t lines_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::size_t count = 0;
  for (std::string line; std::getline(in, line);) ++count;
  return count;
}

/// A run of the scenario that needs 29 clean runs of its trace, not 90.
std::vector<std::string> short_run(std::vector<std::string> more) {
  std::vector<std::string> all = {"run", "scenario.yaml", "--epsilon", "0.15"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

TEST_CASE("Example 1: the box is fetched, ninety clean runs support p below five percent") {
  const CliFixture cli;
  const auto result = json_of(cli, {"run", "scenario.yaml", "--jobs", "2", "--out", "run"});
  CHECK(result["status"] == "ok");
  CHECK(result["verdict"] == "no-discrepancy");
  CHECK(result["iterations"] == 1);
  CHECK(result["simulations"] == 90);
  CHECK(result["exploration"] == "all traces explored");
  const auto& trace = result["traces"][0];
  CHECK(trace["events"] == Json({"Go(r2)", "PickUp()", "Go(r1)", "Place(r1)"}));
  CHECK(trace["certified"]["confidence"] == 0.99);
  CHECK(trace["certified"]["epsilon"].get<double>() == doctest::Approx(0.049881).epsilon(1e-4));
  CHECK(trace["lost"] == 0);
  CHECK(result["discrepancies"].empty());
}

TEST_CASE("every hit is a trace of its own if asked for, and what was not followed is named") {
  const CliFixture cli;
  cli.write("short.yaml",
            "include: common.yaml\n"
            "name: only the way there\n"
            "model: [domain.e, start.e]\n"
            "plan: fetch.lisp\n"
            "bind: robot.bind\n"
            "horizon: 3\n"
            "constraints: [\"HoldsAt(RobotIn(r2),time)\"]\n");
  const std::vector<std::string> base = {"run", "short.yaml",   "--epsilon",
                                         "0.5", "--confidence", "0.5"};
  auto arguments = base;
  arguments.insert(arguments.end(), {"--out", "first"});
  const auto first = json_of(cli, arguments);
  CHECK(first["iterations"] == 1);
  CHECK(first["exploration"] == "all traces explored");
  CHECK_FALSE(first.contains("bounds"));
  arguments = base;
  arguments.insert(arguments.end(), {"--hits", "all", "--out", "all"});
  const auto all = json_of(cli, arguments);
  CHECK(all["iterations"] == 2);
  CHECK(all["traces"][0]["events"] == Json({"Go(r2)"}));
  CHECK(all["traces"][1]["events"] == Json({"Go(r2)", "PickUp()"}));
  CHECK(all["exploration"] == "complete up to bound");
  REQUIRE(all["bounds"].size() == 1);
  const auto bound = all["bounds"][0].get<std::string>();
  CHECK(bound.find("the plan goes on beyond timepoint 3 with Place(") == 0);
  CHECK(bound.find("fetch.lisp:") != std::string::npos);
  CHECK(cli.read("all/report.txt").find(bound) != std::string::npos);
  arguments = base;
  arguments.insert(arguments.end(), {"--split-initial", "--out", "split"});
  CHECK(json_of(cli, arguments)["iterations"] == 1);
}

TEST_CASE("placing at the edge: physics carries the box over the border for some starts") {
  const CliFixture cli;
  const auto result = json_of(cli, {"run", "edge.yaml", "--jobs", "2", "--out", "run"}, 1);
  CHECK(result["verdict"] == "discrepancy");
  const auto& found = result["discrepancies"][0];
  CHECK(found["first_divergence"] == 4);
  bool in_r2 = false;
  for (const auto& fluent : found["fluents"]) {
    if (fluent["fluent"] != "BoxIn(r2)") continue;
    in_r2 = fluent["predicted"] == false && fluent["observed"] == true;
  }
  CHECK(in_r2);
  // Not every start: the first of them must not decide alone over many seeds.
  int first_run = 0;
  for (int seed = 1; seed <= 6; ++seed) {
    const auto other = json_of(cli,
                               {"run", "edge.yaml", "--jobs", "2", "--seed", std::to_string(seed),
                                "--out", "run" + std::to_string(seed)},
                               1);
    if (other["simulations"] == 1) ++first_run;
  }
  CHECK(first_run < 6);
}

TEST_CASE("a model whose pick-up forgets the region is found in the first runs") {
  const CliFixture cli;
  for (const auto* seed : {"1", "2", "3", "4", "5"}) {
    const auto result = json_of(
        cli, {"run", "wrong_model.yaml", "--seed", seed, "--out", std::string("run") + seed}, 1);
    CHECK(result["verdict"] == "discrepancy");
    CHECK(result["simulations"].get<int>() <= 10);
    CHECK(result["discrepancies"][0]["first_divergence"] == 1);
  }
}

TEST_CASE("without friction on the pads the box stays behind, and the tool reports it") {
  const CliFixture cli;
  cli.replace("common.yaml", "include: world.yaml",
              "include: world.yaml\n  friction: {box-pad: 0}");
  const auto result = json_of(cli, {"run", "scenario.yaml", "--out", "run"}, 1);
  CHECK(result["verdict"] == "discrepancy");
  const auto& found = result["discrepancies"][0];
  // Picking up is where it goes wrong, and in the end the box is where it was.
  CHECK(found["first_divergence"] == 2);
  bool behind = false;
  for (const auto& fluent : found["fluents"]) {
    if (fluent["fluent"] == "BoxIn(r2)") behind = fluent["observed"] == true;
  }
  CHECK(behind);
}

TEST_CASE("nothing that is printed or left on disk depends on the number of jobs") {
  const CliFixture cli;
  for (const auto* scenario : {"scenario.yaml", "edge.yaml"}) {
    CAPTURE(scenario);
    std::vector<std::string> out;
    std::vector<std::vector<std::pair<std::string, std::string>>> folders;
    for (const auto* jobs : {"1", "2", "5"}) {
      std::filesystem::remove_all(cli.folder() / "run");
      const auto result = cli.parallax(
          {"run", scenario, "--epsilon", "0.15", "--json", "--jobs", jobs, "--out", "run"});
      out.push_back(without_timing(result.out));
      folders.push_back(files_below(cli.folder() / "run"));
      const auto text = cli.parallax(
          {"run", scenario, "--epsilon", "0.15", "--jobs", jobs, "--out", "run", "--resume"});
      out.back() += text.out;
    }
    CHECK(out[0] == out[1]);
    CHECK(out[0] == out[2]);
    CHECK(folders[0] == folders[1]);
    CHECK(folders[0] == folders[2]);
    CHECK(folders[0].size() >= 3);
  }
}

TEST_CASE("a run that was killed continues to the same report") {
  const CliFixture cli;
  const auto whole = cli.parallax(short_run({"--out", "run", "--json"}));
  REQUIRE(whole.code == 0);
  const auto expected = files_below(cli.folder() / "run");
  std::filesystem::remove_all(cli.folder() / "run");

  const auto journal = cli.folder() / "run" / "journal.ndjson";
  ProcessOptions options;
  options.signal_when = [&] { return lines_of(journal) > 7 ? SIGKILL : 0; };
  const auto killed = cli.parallax(short_run({"--out", "run", "--jobs", "2"}), options);
  REQUIRE(killed.code == 128 + SIGKILL);
  const auto kept = lines_of(journal);
  REQUIRE(kept > 7);
  REQUIRE(kept < 29);

  const auto refused = cli.parallax(short_run({"--out", "run"}));
  CHECK(refused.code == 2);
  CHECK(refused.err.find("--resume") != std::string::npos);
  CHECK(lines_of(journal) == kept);

  const auto resumed = cli.parallax(short_run({"--out", "run", "--resume", "--json"}));
  CHECK(resumed.code == 0);
  CHECK(without_timing(resumed.out) == without_timing(whole.out));
  CHECK(files_below(cli.folder() / "run") == expected);
  const auto timing = Json::parse(resumed.out)["timing"];
  CAPTURE(timing.dump());
}

TEST_CASE("an interrupted run ends with 130 or 143 and keeps what was finished") {
  const CliFixture cli;
  for (const int signal : {SIGINT, SIGTERM}) {
    const auto folder = "run" + std::to_string(signal);
    const auto journal = cli.folder() / folder / "journal.ndjson";
    ProcessOptions options;
    options.signal_when = [&] { return lines_of(journal) > 5 ? signal : 0; };
    const auto result = cli.parallax(short_run({"--out", folder}), options);
    CHECK(result.code == 128 + signal);
    CHECK(lines_of(journal) > 5);
    CHECK(cli.parallax(short_run({"--out", folder, "--resume"})).code == 0);
  }
}

TEST_CASE("replay repeats a recorded simulation bit for bit") {
  const CliFixture cli;
  REQUIRE(cli.parallax({"run", "edge.yaml", "--out", "run"}).code == 1);
  const auto discrepancy = cli.parallax({"replay", "run"});
  CAPTURE(discrepancy.err);
  CHECK(discrepancy.code == 0);
  CHECK(cli.parallax({"replay", "run", "--sample", "1.1"}).code == 0);
  CHECK(cli.parallax({"replay", "run", "--sample", "1.999"}).code == 2);
  CHECK(cli.parallax({"replay", "run", "--sample", "first"}).code == 2);

  SUBCASE("one changed bit in the record is told") {
    auto journal = cli.read("run/journal.ndjson");
    // The last digit of some recorded position of the first simulation.
    const auto at = journal.find("\"tool.x\":", journal.find("\"observations\""));
    REQUIRE(at != std::string::npos);
    const auto end = journal.find(',', at);
    const auto seen = journal.substr(at, end - at);
    auto told = seen;
    told.back() = told.back() == '1' ? '2' : '1';
    auto once = journal;
    cli.write("run/journal.ndjson", once.replace(at, seen.size(), told));
    // The discrepancy was repeated: its record contradicts the repetition.
    const auto odd = cli.parallax({"replay", "run", "--sample", "1.1"});
    CHECK(odd.code == 3);
    CHECK(odd.err.find("differs from the simulation that it repeats") != std::string::npos);
    for (auto next = at; next != std::string::npos; next = journal.find(seen, next)) {
      journal.replace(next, seen.size(), told);
    }
    cli.write("run/journal.ndjson", journal);
    const auto result = cli.parallax({"replay", "run", "--sample", "1.1"});
    CHECK(result.code == 1);
    CHECK((result.out + result.err).find("tool.x") != std::string::npos);
  }
  SUBCASE("another scenario cannot be compared") {
    cli.replace("world.yaml", "mass_kg: 0.3", "mass_kg: 0.31");
    // The texts that the run kept are repeated; without them nothing can be.
    const auto kept = cli.parallax({"replay", "run"});
    CHECK(kept.code == 0);
    CHECK(kept.err.find("the texts that the run kept count") != std::string::npos);
    std::filesystem::remove(cli.folder() / "run" / "inputs.json");
    CHECK(cli.parallax({"replay", "run"}).code == 3);
  }
  SUBCASE("a command that the scenario names by now is not started") {
    cli.write("edge.yaml", cli.read("edge.yaml") + "simulator: {command: [touch, started]}\n");
    for (const auto* command : {"replay", "draw", "explain"}) {
      CAPTURE(command);
      (void)cli.parallax({command, "run"});
      CHECK_FALSE(std::filesystem::exists(cli.folder() / "started"));
    }
    std::filesystem::remove(cli.folder() / "run" / "inputs.json");
    for (const auto* command : {"replay", "draw", "explain"}) {
      CAPTURE(command);
      const auto result = cli.parallax({command, "run"});
      CHECK(result.code != 0);
      CHECK(result.err.find("hash") != std::string::npos);
      CHECK_FALSE(std::filesystem::exists(cli.folder() / "started"));
    }
  }
}

}  // namespace
}  // namespace parallax::test
