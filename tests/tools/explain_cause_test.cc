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
  CHECK(closed.out.find("of executed plans none are made") != std::string::npos);

  REQUIRE(cli.parallax({"run", "two/unparks.yaml", "--out", "old"}).code == 1);
  cli.write("two/domain.e", cli.read("two/domain.e") + "; changed\n");
  const auto changed = cli.parallax({"explain", "old"});
  CHECK(changed.code == 3);
  CHECK(changed.err.find("has changed: its hash was") != std::string::npos);
}

}  // namespace
}  // namespace parallax::test
