// Kinds of cause, by the runs of a folder and by further ones.

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"
#include "tests/tools/two_models.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

TEST_CASE("a wrong axiom: it happens always, shown by further runs that the run knows nothing of") {
  const TwoModels cli;
  REQUIRE(cli.parallax({"run", "two/unparks.yaml", "--out", "out"}).code == 1);
  const auto journal = cli.read("out/journal.ndjson");
  auto told = json_of(cli, {"explain", "out", "--runs", "0"}, 1);
  CHECK(told.at("cause") == "unknown");
  CHECK(told.at("evidence").at("runs") == 1);
  CHECK_FALSE(fs::exists(cli.folder() / "out" / "further"));
  told = json_of(cli, {"explain", "out"}, 1);
  CHECK(told.at("cause") == "always");
  CHECK(told.at("evidence").at("failures") == 10);
  CHECK(told.at("evidence").at("further") == 9);
  CHECK(told.at("sets").at(0).at("words").get<std::string>().find("inertia from 0") !=
        std::string::npos);
  CHECK(cli.read("out/journal.ndjson") == journal);
  // The second time they are on record.
  const auto further = cli.read("out/further/journal.ndjson");
  CHECK(std::count(further.begin(), further.end(), '\n') == 11);
  CHECK(json_of(cli, {"explain", "out"}, 1).at("cause") == "always");
  CHECK(cli.read("out/further/journal.ndjson") == further);
  CHECK(cli.parallax({"run", "two/unparks.yaml", "--out", "out", "--resume"}).code == 1);
  CHECK(cli.read("out/journal.ndjson") == journal);
}

TEST_CASE("an open outcome: from one start so and so, which is said first") {
  const TwoModels cli;
  REQUIRE(cli.parallax({"run", "two/sticks.yaml", "--out", "out", "--seed", "5"}).code == 1);
  const auto told = json_of(cli, {"explain", "out"}, 1);
  CHECK(told.at("cause") == "random");
  CHECK(told.at("evidence").at("contradictory_starts") == 1);
  REQUIRE(cli.parallax({"run", "two/sticks.yaml", "--out", "all", "--keep-going", "--seed", "5"})
              .code == 1);
  const auto text = cli.parallax({"explain", "all"});
  CHECK(text.out.starts_with("From one and the same start some runs go wrong"));
}

TEST_CASE("a region that is too coarse: the parameter and the border are named") {
  const CliFixture cli;
  // The arm reaches the box from the right part of the robot's region only.
  REQUIRE(cli.parallax({"run", "wrong_model.yaml", "--out", "out"}).code == 1);
  const auto told = json_of(cli, {"explain", "out", "--jobs", "2"}, 1);
  CAPTURE(told.dump());
  CHECK(told.at("cause") == "region");
  CHECK(told.at("rule").at("accuracy") > 0.7);
}

TEST_CASE("executions from the state that the discrepancy began in") {
  const TwoModels cli;
  REQUIRE(cli.parallax({"run", "two/unparks.yaml", "--execution", "closed-loop", "--out", "out"})
              .code == 1);
  const auto journal = cli.read("out/journal.ndjson");
  const auto told = json_of(cli, {"explain", "out"}, 1);
  CHECK(told.at("cause") == "always");
  CHECK(told.at("evidence").at("failures") >= 10);
  CHECK(told.at("evidence").at("further") == 10);
  CHECK(cli.read("out/journal.ndjson") == journal);
  // On record, and the same for any number of jobs.
  const auto further = cli.read("out/further/journal.ndjson");
  CHECK(further.find("to tell the kind of cause") != std::string::npos);
  CHECK(json_of(cli, {"explain", "out"}, 1).at("evidence") == told.at("evidence"));
  CHECK(cli.read("out/further/journal.ndjson") == further);
  fs::remove_all(cli.folder() / "out" / "further");
  json_of(cli, {"explain", "out", "--jobs", "3"}, 1);
  CHECK(cli.read("out/further/journal.ndjson") == further);
  // Chance is distinguished: the same start gives different outcomes.
  REQUIRE(cli.parallax({"run", "two/sticks.yaml", "--execution", "closed-loop", "--out", "sticks"})
              .code == 1);
  CHECK(json_of(cli, {"explain", "sticks"}, 1).at("cause") == "random");
}

TEST_CASE("the failing start itself, with other seeds and with half the simulator's step") {
  const CliFixture cli;
  REQUIRE(cli.parallax({"run", "wrong_model.yaml", "--out", "out"}).code == 1);
  const auto told = json_of(cli, {"explain", "out", "--jobs", "2"}, 1);
  CAPTURE(told.dump());
  for (const auto* name : {"other_seeds", "half_step"}) {
    CHECK(told.at("evidence").at(name).at("runs") == 5);
    CHECK(told.at("evidence").at(name).at("failures") == 5);
  }
  CHECK(told.at("cause_words")
            .get<std::string>()
            .find("From the failing start once more: with other seeds of the simulator it happens "
                  "in 5 of "
                  "5 runs, with half its step it happens in 5 of 5 runs.") != std::string::npos);
  const auto same = cli.read("out/same_start/journal.ndjson");
  CHECK(std::count(same.begin(), same.end(), '\n') == 7);
  CHECK(json_of(cli, {"explain", "out"}, 1).at("evidence") == told.at("evidence"));
  CHECK(cli.read("out/same_start/journal.ndjson") == same);
  CHECK_FALSE(
      json_of(cli, {"explain", "out", "--runs", "0"}, 1).at("evidence").contains("half_step"));
}

TEST_CASE("a run without a discrepancy, a changed model and an executed plan") {
  const TwoModels cli;
  REQUIRE(cli.parallax({"run", "two/agree.yaml", "--out", "clean", "--epsilon", "0.5"}).code == 0);
  const auto clean = cli.parallax({"explain", "clean"});
  CHECK(clean.code == 0);
  CHECK(clean.out.find("there is nothing to explain") != std::string::npos);
  CHECK(clean.out.find("--why") != std::string::npos);

  REQUIRE(cli.parallax({"run", "two/unparks.yaml", "--execution", "closed-loop", "--out", "closed"})
              .code == 1);
  const auto closed = cli.parallax({"explain", "closed"});
  CHECK(closed.code == 1);
  CHECK(closed.out.find("It happens always, in each of") != std::string::npos);

  REQUIRE(cli.parallax({"run", "two/unparks.yaml", "--out", "old"}).code == 1);
  cli.write("two/domain.e", cli.read("two/domain.e") + "; changed\n");
  CHECK(cli.parallax({"explain", "old"}).code == 1);  // of the texts that the run kept
  std::filesystem::remove(cli.folder() / "old/inputs.json");
  const auto changed = cli.parallax({"explain", "old"});
  CHECK(changed.code == 3);
  CHECK(changed.err.find("has changed: its hash was") != std::string::npos);
}

}  // namespace
}  // namespace parallax::test
