// Pictures of simulations that left a recording: nothing is simulated a second time for them.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/xml.h"
#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

const std::string kAgain = "is simulated again, without its recording: ";

std::vector<std::string> texts_of(const XmlElement& svg) {
  std::vector<std::string> out;
  for (const auto* text : svg.all("text")) out.push_back(text->text);
  std::sort(out.begin(), out.end());
  return out;
}

/// Class and title of each group of marks, in their order.
std::vector<std::string> marks_of(const XmlElement& svg) {
  std::vector<std::string> out;
  for (const auto* group : svg.all("g")) {
    auto mark = group->at("class");
    for (const auto& child : group->children) {
      if (child.name == "title") mark += ": " + child.text;
    }
    out.push_back(std::move(mark));
  }
  return out;
}

/// The same labels and marks in every picture.
void check_same(const CliFixture& cli, const std::string& a, const std::string& b) {
  int pictures = 0;
  for (const auto& [path, text] : files_below(cli.folder() / a)) {
    if (!path.ends_with(".svg")) continue;
    CAPTURE(path);
    const auto one = parse_xml(text);
    const auto other = parse_xml(cli.read(b + "/" + fs::path(path).filename().string()));
    CHECK(texts_of(one) == texts_of(other));
    CHECK(marks_of(one) == marks_of(other));
    ++pictures;
  }
  CHECK(pictures > 1);
}

TEST_CASE("a recording is drawn without a simulator, and shows what a simulation shows") {
  const CliFixture cli;
  for (const std::string scenario : {"edge", "wrong_model"}) {
    CAPTURE(scenario);
    REQUIRE(cli.parallax({"run", scenario + ".yaml", "--seed", "5", "--out", scenario}).code == 1);
    const auto recorded = cli.parallax({"draw", scenario, "-o", scenario + "/a"});
    CHECK(recorded.code == 0);
    CHECK(recorded.err.find(kAgain) == std::string::npos);
    // Made by an engine that is not there: no simulator of this program could repeat it.
    auto journal = cli.read(scenario + "/journal.ndjson");
    const std::string key = "\"version\":\"";
    const auto at = journal.find(key, journal.find("\"simulator\":"));
    REQUIRE(at < journal.find('\n'));
    cli.write(scenario + "/journal.ndjson",
              journal.substr(0, at) + key + "0.0." + journal.substr(at + key.size()));
    const auto without = cli.parallax({"draw", scenario, "-o", scenario + "/b"});
    CAPTURE(without.err);
    CHECK(without.code == 0);
    CHECK(files_below(cli.folder() / scenario / "a") == files_below(cli.folder() / scenario / "b"));
    fs::rename(cli.folder() / scenario / "recordings", cli.folder() / scenario / "elsewhere");
    CHECK(cli.parallax({"draw", scenario, "-o", scenario + "/c"}).code == 3);
    cli.write(scenario + "/journal.ndjson", journal);
    const auto again = cli.parallax({"draw", scenario, "-o", scenario + "/c"});
    CHECK(again.code == 0);
    CHECK(again.err.find(kAgain + "there is none") != std::string::npos);
    check_same(cli, scenario + "/a", scenario + "/c");
  }
}

TEST_CASE("a recording that is broken, or of something else, is told of, and not drawn") {
  const CliFixture cli;
  REQUIRE(cli.parallax({"run", "edge.yaml", "--seed", "5", "--out", "run"}).code == 1);
  REQUIRE(cli.parallax({"draw", "run", "-o", "whole"}).code == 0);
  const std::string file = "run/recordings/1.2.rec";
  const auto bytes = cli.read(file);
  std::string why;
  SUBCASE("cut short") {
    cli.write(file, bytes.substr(0, bytes.size() / 2));
    why = "byte ";
  }
  SUBCASE("another simulation's") {
    cli.write(file, cli.read("run/recordings/1.1.rec"));
    why = "it is that of simulation 1.1";
  }
  SUBCASE("of another run") {
    REQUIRE(cli.parallax({"run", "edge.yaml", "--seed", "6", "--record", "all", "--out", "other"})
                .code <= 1);
    cli.write(file, cli.read("other/recordings/1.2.rec"));
    why = "it says other things than the journal";
  }
  const auto result = cli.parallax({"draw", "run", "-o", "again"});
  CAPTURE(result.err);
  CHECK(result.code == 0);
  CHECK(result.err.find("simulation 1.2 " + kAgain + why) != std::string::npos);
  check_same(cli, "whole", "again");
}

}  // namespace
}  // namespace parallax::test
