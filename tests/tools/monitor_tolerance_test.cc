// Logs with noise and wrong values: what is tolerated, what is not, and what the verdict says of
// it.

#include <doctest/doctest.h>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

std::string seen(double t, double robot, double box) {
  return Json{{"t", t}, {"state", {{"robot.x", robot}, {"box.x", box}, {"box.held", false}}}}
             .dump() +
         "\n";
}

const std::string kWent = R"j({"t": 1, "event": "Go(r2)"}
)j";

Json tolerant(const CliFixture& cli, const std::string& log, int code,
              const std::vector<std::string>& options) {
  cli.write("log.jsonl", log);
  std::vector<std::string> words = {"monitor", "scenario.yaml", "log.jsonl"};
  words.insert(words.end(), options.begin(), options.end());
  return json_of(cli, words, code);
}

TEST_CASE("a sample a millimetre outside of a cell is tolerated where that is asked for") {
  const CliFixture cli;
  const std::vector<std::string> within = {"--tolerance-m", "0.005"};
  // Outside of all regions, and on the wrong side of the border of two.
  const std::string log = seen(0, -0.001, 1.5) + kWent + seen(1.1, 0.999, 1.5) +
                          seen(1.2, 1.001, 1.5) + seen(1.3, 1.5, 2.001);
  CHECK(tolerant(cli, log, 1, {}).at("first").at("line") == 1);
  const auto result = tolerant(cli, log, 0, within);
  CHECK(result.at("verdict") == "consistent");
  CHECK(result.at("compared") == 4);
  CHECK(result.at("tolerated").at("tolerance_m") == 0.005);
  // 0.999 needs it, and 1.001 does not.
  CHECK(result.at("tolerated").at("near_border") == 4);
  CHECK(result.at("tolerated").at("only_within_tolerance") == 3);
  const auto text =
      cli.parallax({"monitor", "scenario.yaml", "log.jsonl", "--tolerance-m", "0.005"});
  CHECK(text.out.find("tolerated: 4 observations within 0.005 m or 0 rad of a border, where both "
                      "sides are possible; 3 agree with the model only so\n") != std::string::npos);
  // Without an option the verdict says nothing of it.
  CHECK_FALSE(tolerant(cli, seen(0, 0.5, 1.5), 0, {}).contains("tolerated"));
}

TEST_CASE("the tolerance ends where it says, and a body near a border is somewhere") {
  const CliFixture cli;
  const std::vector<std::string> within = {"--tolerance-m", "0.005"};
  const auto far = tolerant(cli, seen(0, 0.5, 1.5) + kWent + seen(1.1, 0.994, 1.5), 1, within);
  CHECK(far.at("first").at("line") == 2 + 1);
  CHECK(far.at("first").at("fluents").at(0).at("fluent") == "RobotIn(r1)");
  CHECK(
      tolerant(cli, seen(0, -0.006, 1.5), 1, within).at("first").at("fluents").at(0).at("fluent") ==
      "RobotIn(outside)");
  // Near the border of r1 and r2: in one of them, so not in neither, which the model has no axiom
  // against.
  cli.write("loose.e", R"e(sort region
region r1, r2
fluent RobotIn(region)
fluent BoxIn(region)
fluent Holding()
event Go(region)
event PickUp()
event Place(region)
range time 0 2
[region,time] Initiates(Go(region),RobotIn(region),time).
)e");
  cli.write("loose.yaml", "include: common.yaml\nmodel: loose.e\nhorizon: 2\n");
  cli.write("log.jsonl", seen(0, 1.0, 1.5));
  const auto result =
      json_of(cli, {"monitor", "loose.yaml", "log.jsonl", "--tolerance-m", "0.005"});
  CHECK(result.at("states").at("last") == 3);
}

TEST_CASE("an outlier is passed over and listed, a discrepancy is not") {
  const CliFixture cli;
  const std::vector<std::string> rate = {"--outliers", "1/10"};
  std::string log = seen(0, 0.5, 1.5) + kWent;
  for (int i = 0; i < 4; ++i) log += seen(1.1 + i, i == 2 ? 7.0 : 1.5, 1.5);
  CHECK(tolerant(cli, log, 1, {}).at("first").at("line") == 5);
  const auto result = tolerant(cli, log, 0, rate);
  CHECK(result.at("tolerated").at("outliers") ==
        Json{{"at_most", 1}, {"of", 10}, {"count", 1}, {"first_lines", {5}}});
  const auto text = cli.parallax({"monitor", "scenario.yaml", "log.jsonl", "--outliers", "1/10"});
  CHECK(text.out.find("not counted: 1 outlier of 5 compared, as 1 of 10 in a row may be wrong\n"
                      "  line 5, t = 3.1 s\n    RobotIn(outside)") != std::string::npos);
  // The second one within ten observations is one too many; it began there.
  const auto second = tolerant(cli, log + seen(6, 7.0, 1.5), 1, rate);
  CHECK(second.at("first").at("line") == 5);
  std::string later = log;
  for (int i = 0; i < 8; ++i) later += seen(6 + i, 1.5, 1.5);
  CHECK(tolerant(cli, later + seen(20, 7.0, 1.5), 0, rate)
            .at("tolerated")
            .at("outliers")
            .at("count") == 2);
  // One observation between two steps confirms itself by nothing: it is no outlier.
  const auto alone = tolerant(cli, seen(0, 0.5, 1.5) + kWent + seen(1.1, 0.5, 1.5), 1, rate);
  CHECK(alone.at("first").at("line") == 3);
  CHECK(alone.at("tolerated").at("outliers").at("count") == 0);
  CHECK(tolerant(cli,
                 seen(0, 0.5, 1.5) + kWent + seen(1.1, 0.5, 1.5) +
                     "{\"t\": 2, \"event\": "
                     "\"PickUp()\"}\n",
                 1, rate)
            .at("first")
            .at("line") == 3);
}

TEST_CASE("a rate that is none, and a run folder, are refused") {
  const CliFixture cli;
  cli.write("log.jsonl", seen(0, 0.5, 1.5));
  for (const auto* bad : {"1", "5/10", "-1/10", "1/0", "x/y", "1/10x", "1/99999999"}) {
    CAPTURE(bad);
    const auto result =
        cli.parallax({"monitor", "scenario.yaml", "log.jsonl", std::string("--outliers=") + bad});
    CHECK(result.code == 2);
    CHECK(result.err.find("is not `N/OF`") != std::string::npos);
  }
  CHECK(cli.parallax({"monitor", "scenario.yaml", "log.jsonl", "--tolerance-m", "-1"}).code == 2);
}

}  // namespace
}  // namespace parallax::test
