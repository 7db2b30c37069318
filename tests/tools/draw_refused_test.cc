// Messages of `parallax draw` where there is nothing to draw, or not all of it.

#include <doctest/doctest.h>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

TEST_CASE("what cannot be drawn is told with its exit code") {
  const CliFixture cli;
  const auto complains = [&](const std::vector<std::string>& words, int code,
                             const std::string& part) {
    auto arguments = words;
    arguments.insert(arguments.begin(), "draw");
    const auto result = cli.parallax(arguments);
    CAPTURE(result.err);
    CHECK(result.code == code);
    CHECK(result.out.empty());
    CHECK(result.err.find(part) != std::string::npos);
  };
  complains({"missing.yaml"}, 2, "missing.yaml: error");
  complains({"edge.yaml", "--sample", "1.1"}, 2, "--sample");
  cli.write("broken.yaml", "name: [");
  complains({"broken.yaml"}, 3, "broken.yaml:1:");
  cli.write("taken", "");
  complains({"edge.yaml", "-o", "taken/world.svg"}, 2, "taken/world.svg");
  std::filesystem::create_directory(cli.folder() / "empty");
  complains({"empty"}, 2, "no journal");

  REQUIRE(cli.parallax({"run", "edge.yaml", "--out", "run"}).code == 1);
  complains({"run", "--sample", "1.9"}, 2, "no simulation 1.9");
  complains({"run", "--sample", "one"}, 2, "--sample");
  const auto journal = cli.read("run/journal.ndjson");
  SUBCASE("a journal of which only the first line was written has no simulation") {
    cli.write("run/journal.ndjson", journal.substr(0, journal.find('\n') + 1));
    complains({"run"}, 2, "no simulation");
  }
  SUBCASE("a first line that was cut off is no journal") {
    cli.write("run/journal.ndjson", journal.substr(0, 40));
    complains({"run"}, 2, "no journal");
  }
  SUBCASE("a foreign line is named with its place") {
    cli.write("run/journal.ndjson", journal.substr(0, journal.find('\n') + 1) + "{}\n");
    complains({"run"}, 3, "run/journal.ndjson:2:");
  }
  SUBCASE("a scenario that has changed since shows other simulations") {
    cli.replace("world.yaml", "mass_kg: 0.3", "mass_kg: 0.31");
    std::filesystem::remove(cli.folder() / "run/inputs.json");
    complains({"run"}, 3, "has changed");
  }
  SUBCASE("a record that was tampered with is not what happens") {
    auto changed = journal;
    const auto at = changed.find("\"sim_time_s\":");
    REQUIRE(at != std::string::npos);
    const auto seen = changed.substr(at, changed.find('}', at) - at);
    auto told = seen;
    told[13] = told[13] == '9' ? '8' : '9';
    cli.write("run/journal.ndjson", changed.replace(at, seen.size(), told));
    complains({"run"}, 3, "differs from the simulation that it repeats");
    // The repetition says the same.
    for (auto next = at; next != std::string::npos; next = changed.find(seen, next)) {
      changed.replace(next, seen.size(), told);
    }
    cli.write("run/journal.ndjson", changed);
    complains({"run"}, 3, "ended otherwise than recorded");
  }
}

TEST_CASE("a run whose last line was cut off is drawn as far as it goes, with a warning") {
  const CliFixture cli;
  REQUIRE(cli.parallax({"run", "edge.yaml", "--seed", "5", "--out", "run"}).code == 1);
  auto journal = cli.read("run/journal.ndjson");
  cli.write("run/journal.ndjson", journal.substr(0, journal.size() - 30));
  const auto result = cli.parallax({"draw", "run", "--sample", "1.1"});
  CHECK(result.code == 0);
  CHECK(result.err.find("run/journal.ndjson") != std::string::npos);
  CHECK(files_below(cli.folder() / "run/pictures").size() == 6);  // with the page over them
}

}  // namespace
}  // namespace parallax::test
