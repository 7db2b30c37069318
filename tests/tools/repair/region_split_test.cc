// A start region that is too coarse: `parallax repair` splits it where the runs show.

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "compiler/repair/start_split.h"
#include "compiler/sema/check.h"
#include "compiler/syntax/loader.h"
#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

const std::string kBorder = "BoxFarX(): {start: box.x, above: 1.76}\n";

/// The box at the edge of r1, run and explained: 10 of 37 runs fail, those from beyond 1.76.
void run_edge(const CliFixture& cli) {
  REQUIRE(cli.parallax({"run", "edge.yaml", "--out", "out", "--seed", "1"}).code == 1);
  REQUIRE(json_of(cli, {"explain", "out"}, 1).at("cause") == "region");
}

TEST_CASE("the split is the first proposal; git takes it, and then both halves are as predicted") {
  const CliFixture cli;
  run_edge(cli);
  const auto report = json_of(cli, {"repair", "out"}, 1);
  const auto& first = report.at("proposals").at(0);
  CHECK(first.at("changes") == "scenario");
  CHECK(first.at("runs_consistent") == 37);
  CHECK(first.at("runs") == 37);
  CHECK_FALSE(first.at("precaution"));
  CHECK(first.at("words").get<std::string>().starts_with(
      "the region `r2`, where `box` begins, is split at `box.x` = 1.76"));
  CHECK(first.at("evidence").at(0) ==
        "10 of 10 failures and 0 of 27 clean runs have `box.x` > 1.76.");
  CHECK(
      first.at("evidence").at(1).get<std::string>().starts_with("No run began with `box.x` from"));
  cli.write("p.diff", first.at("patch").get<std::string>());
  ProcessOptions here;
  here.folder = cli.folder().string();
  const auto checked = run_process({"git", "apply", "--check", "p.diff"}, here);
  CHECK_MESSAGE(checked.code == 0, checked.err << first.at("patch"));

  const auto model = cli.read("domain.e"), scenario = cli.read("common.yaml");
  CHECK(cli.parallax({"repair", "out", "--apply", "1"}).code == 0);
  // Nothing but new lines in the scenario, comments and layout as they were.
  auto changed = cli.read("common.yaml");
  const auto at = changed.find("  " + kBorder);
  REQUIRE(at != std::string::npos);
  CHECK(changed.erase(at, 2 + kBorder.size()) == scenario);
  CHECK(run_process({"git", "apply", "--check", "-R", "p.diff"}, here).code == 0);

  const auto again = json_of(cli, {"run", "edge.yaml", "--out", "again", "--seed", "1"});
  CHECK(again.at("verdict") == "no-discrepancy");
  // For the other half, the model now says what is seen there: the box comes to lie in r2.
  cli.replace("edge.yaml", "(Happens(Place(region),time-1) & HoldsAt(BoxIn(region),time))",
              "Happens(Place(region),time-1)");
  const auto halves =
      json_of(cli, {"run", "edge.yaml", "--split-initial", "--out", "halves", "--seed", "1"}, 1);
  // Where exactly the border is no run has shown: the far half may have a few that go well.
  REQUIRE(halves.at("traces").size() == 2);
  CHECK(halves.at("traces").at(0).at("verdict") == "no-discrepancy");
  CHECK(halves.at("traces").at(1).at("simulations") > 3);
  // With the old sentences it is a discrepancy.
  cli.write("domain.e", model);
  cli.write("common.yaml", scenario);
  CHECK(cli.parallax({"run", "edge.yaml", "--out", "old", "--seed", "1"}).code == 1);
}

TEST_CASE("rounds in physics: split, run again, clean") {
  const CliFixture cli;
  REQUIRE(cli.parallax({"run", "edge.yaml", "--out", "out", "--epsilon", "0.5"}).code == 1);
  REQUIRE(json_of(cli, {"explain", "out"}, 1).at("cause") == "region");
  const auto report = json_of(cli, {"repair", "out", "--loop", "--out", "fixed"});
  CAPTURE(report.dump(1));
  CHECK(report.at("end") == "clean");
  REQUIRE(report.at("rounds").size() == 1);
  const auto& round = report.at("rounds").at(0);
  CHECK(round.at("words").get<std::string>().find("is split at `box.x` = 1.76") !=
        std::string::npos);
  CHECK(round.at("verdict") == "no-discrepancy");
  // The mapping that was run again is that of the copy, which has the border.
  CHECK(cli.read("fixed/files/common.yaml").find(kBorder) != std::string::npos);
  CHECK(cli.read("common.yaml").find("BoxFarX") == std::string::npos);
}

/// Fluents and events of each trace, without one fluent, and the number of such traces.
std::map<std::string, int> traces_without(const CliFixture& cli, const std::string& fluent) {
  const auto result =
      cli.parallax({"traces", "both.e", "--limit", "0", "--horizon", "3", "--format", "jsonl"});
  CHECK(result.code == 0);
  std::map<std::string, int> out;
  std::istringstream lines(result.out);
  for (std::string line; std::getline(lines, line);) {
    auto trace = Json::parse(line);
    if (!trace.contains("timepoints")) continue;
    for (auto& point : trace.at("timepoints")) {
      auto& holds = point.at("holds");
      holds.erase(std::remove(holds.begin(), holds.end(), Json(fluent)), holds.end());
    }
    ++out[trace.at("timepoints").dump()];
  }
  return out;
}

TEST_CASE("both halves treated alike: each trace of the old model is there once in each half") {
  const CliFixture cli;
  cli.write("both.e", cli.read("domain.e") + cli.read("start.e") +
                          "[event1,event2,time] Happens(event1,time) & Happens(event2,time) -> "
                          "event1=event2.\n");
  const auto before = traces_without(cli, "");
  CHECK(before.size() > 10);

  base::SourceFiles files;
  base::DiagnosticSink sink;
  const std::vector<std::filesystem::path> paths = {cli.folder() / "both.e"};
  const auto ast = compiler::load_model(paths, compiler::LoadOptions(), files, sink);
  REQUIRE(ast);
  compiler::CheckOptions check;
  check.time_lower = 0;
  check.time_upper = 3;
  const auto typed = compiler::check_model(*ast, files, sink, check);
  REQUIRE(typed);
  SUBCASE("of a thing that the model has no name for") {
    const compiler::StartFluent far{"BoxFarX", "", "", "At the start box.x > 1.76."};
    const auto change = compiler::declare(far, *ast, *typed, files);
    cli.write("both.e", compiler::changed_text(files[change.file].text(), change.file, {change}));
  }
  SUBCASE("of one of several constants: of the others it never holds") {
    const compiler::StartFluent far{"BoxFarX", "region", "r2", "Somehow."};
    const auto change = compiler::declare(far, *ast, *typed, files);
    cli.write("both.e", compiler::changed_text(files[change.file].text(), change.file, {change}));
  }
  auto after = traces_without(cli, "BoxFarX()");
  if (after.size() != before.size()) after = traces_without(cli, "BoxFarX(r2)");
  CHECK(after.size() == before.size());
  for (const auto& [trace, times] : before) {
    CHECK(times == 1);
    CHECK(after[trace] == 2);
  }
}

TEST_CASE("too few runs to tell: the command that makes more is named") {
  const CliFixture cli;
  // Some runs are clean before one fails.
  REQUIRE(json_of(cli, {"run", "edge.yaml", "--out", "out", "--seed", "2"}, 1).at("simulations") >
          1);
  const auto result = cli.parallax({"repair", "out"});
  CAPTURE(result.out);
  CHECK(result.out.find("`parallax explain out --runs 120` makes more") != std::string::npos);
}

TEST_CASE("one of two ways to say a border") {
  const CliFixture cli;
  cli.replace("domain.e", "fluent Holding()", "fluent Holding()\nfluent Far()");
  const auto errors = [&](const std::string& value) {
    const CliFixture own;
    own.write("domain.e", cli.read("domain.e"));
    own.replace("common.yaml", "  Holding(): {flag: box.held}\n",
                "  Holding(): {flag: box.held}\n  Far(): {start: box.x" + value + "}\n");
    return own.parallax({"check", "edge.yaml"}).err;
  };
  CHECK(errors(", above: 1.5").find("error[") == std::string::npos);
  CHECK(errors(", up_to: 1.5").find("error[") == std::string::npos);
  CHECK(errors("").find("`above`") != std::string::npos);
  CHECK(errors(", above: 1, up_to: 2").find("must be alone") != std::string::npos);
  CHECK(errors(", above: high").find("not a number") != std::string::npos);
  CHECK(errors(", above: 1, compare: final").find("`compare`") != std::string::npos);
}

}  // namespace
}  // namespace parallax::test
