// `parallax suite` on scenarios: the expectations of a case, its outcome, and the report.

#include <doctest/doctest.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "tests/support/xml.h"
#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Replaces the expectation of wrong_model.yaml, the quickest of the scenarios.
void expect(const CliFixture& cli, const std::string& name, const std::string& what) {
  auto text = cli.read("wrong_model.yaml");
  cli.write(name, text.erase(text.find("expect:")) + "expect: " + what + "\n");
}

std::string first_problem(const Json& document) {
  REQUIRE(document["cases"].size() == 1);
  const auto& problems = document["cases"][0]["problems"];
  return problems.empty() ? "" : problems[0].get<std::string>();
}

TEST_CASE(
    "every scenario below a folder that expects something is a case, with a line as it ends") {
  const CliFixture cli;
  // Three scenarios; their parts, plans and models are no cases.
  cli.write("scenario.yaml", "name: expects nothing\n");
  cli.write("edge.yaml", "name: expects nothing either\n");
  std::filesystem::create_directories(cli.folder() / "deep/er");
  expect(cli, "one.yaml", "{verdict: discrepancy}");
  expect(cli, "two.yaml", "{verdict: no-discrepancy}");
  const auto result =
      cli.parallax({"suite", ".", "--jobs", "2", "--junit", "junit.xml", "--color=never"});
  CHECK(result.code == 1);
  CHECK(result.out.ends_with("\n2 passed, 1 failed\n"));
  CHECK(holds(result.err, "ok    one.yaml ("));
  CHECK(holds(result.err, "ok    wrong_model.yaml ("));
  CHECK(result.out.starts_with("FAIL  two.yaml ("));
  CHECK(holds(result.out, "\n       verdict discrepancy, expected no-discrepancy"));
  // Why, and where to read on, without opening anything.
  CHECK(holds(result.out, "\n       1.1: PickUp() fails (out of reach: `box` lies "));
  CHECK(holds(result.out, "\n       report: out/suite/two.yaml/report.txt"));
  CHECK_FALSE(holds(result.err, "FAIL"));
  CHECK(std::filesystem::exists(cli.folder() / "out/suite/two.yaml/report.txt"));

  const auto junit = parse_xml(cli.read("junit.xml"));
  CHECK(junit.name == "testsuites");
  CHECK(junit.at("tests") == "3");
  CHECK(junit.at("failures") == "1");
  CHECK(junit.all("testcase").size() == 3);
  REQUIRE(junit.all("failure").size() == 1);
  CHECK(holds(junit.all("failure")[0]->at("message"), "expected no-discrepancy"));

  CHECK(cli.parallax({"suite", ".", "--only", "one", "--no-cache"}).out == "1 passed, 0 failed\n");
  CHECK(cli.parallax({"suite", ".", "--only", "three"}).code == 2);
  CHECK(cli.parallax({"suite", "nowhere"}).code == 2);
}

TEST_CASE("each kind of expectation passes where it is met and says what was found where not") {
  const CliFixture cli;
  const auto problem = [&](const std::string& what, int code) {
    expect(cli, "case.yaml", what);
    return first_problem(json_of(cli, {"suite", "case.yaml"}, code));
  };
  CHECK(
      problem("{verdict: discrepancy, iterations: 1, max_simulations: 3, fluents: [BoxIn(r1)]}", 0)
          .empty());
  CHECK(problem("{iterations: 2}", 1) == "1 iterations, expected 2");
  CHECK(problem("{max_simulations: 0}", 1) == "1 simulations, expected at most 0");
  CHECK(problem("{fluents: [RobotIn(r1)]}", 1) == "RobotIn(r1) did not diverge");
  CHECK(problem("{fluents: [Holding()]}", 0).empty());
  CHECK(problem("{fluents: [Holding()]}\ncompare: final", 1) ==
        "Holding() diverged on the way, but not in the end, which is what counts");
  // Out of reach in 82 % by geometry.
  CHECK(problem("{rate: {between: [0.8, 0.85], runs: 25}}", 0).empty());
  CHECK(holds(problem("{rate: {between: [0.01, 0.1], runs: 12}}", 1), "expected 1 to 10 %"));
  CHECK(holds(problem("{rate: {between: [0.99, 1], runs: 40, trace: 2}}", 1), "input was refused"));
}

TEST_CASE("a rate is that of parallax rates with the suite's seed") {
  const CliFixture cli;
  expect(cli, "case.yaml", "{rate: {between: [0, 0], runs: 10}}");
  const auto problem = first_problem(json_of(cli, {"suite", "case.yaml", "--seed", "7"}, 1));
  const auto rates = json_of(cli, {"rates", "case.yaml", "--seed", "7", "--runs", "10"});
  const auto found = rates["traces"][0]["any"]["count"].get<int>();
  CHECK(holds(problem, "discrepancies in " + std::to_string(found) + " of 10 runs of trace 1"));
}

TEST_CASE("a case that cannot be run or runs too long is an error, and the others run on") {
  const CliFixture cli;
  cli.write("scenario.yaml", "name: expects nothing\n");
  cli.write("edge.yaml", "horizon: [\nexpect: {verdict: discrepancy}\n");
  expect(cli, "long.yaml", "{rate: {between: [0, 1], runs: 1000000}, time_limit_s: 1}");
  const auto document = json_of(cli, {"suite", ".", "--jobs", "3"}, 1);
  CHECK(document["passed"] == 1);
  CHECK(document["errors"] == 2);
  CHECK(document["cases"][0]["case"] == "edge.yaml");
  CHECK(document["cases"][0]["problems"][0] == "the input was refused");
  CHECK(document["cases"][1]["problems"][0] == "inconclusive: a limit ended it first");
}

TEST_CASE("a simulator that does not start is an error with its reason, no failure") {
  const CliFixture cli;
  cli.write("case.yaml", "include: wrong_model.yaml\nsimulator: {command: [/bin/false]}\n");
  const auto document =
      json_of(cli, {"suite", "case.yaml", "--junit", "junit.xml", "--allow-commands"}, 1);
  CHECK(document["errors"] == 1);
  CHECK(document["failed"] == 0);
  CHECK(holds(document["cases"][0]["problems"][1], "E7108: the simulator did not start"));
  CHECK(parse_xml(cli.read("junit.xml")).all("error").size() == 1);
}

TEST_CASE("a variant takes back what the included scenario expects") {
  const CliFixture cli;
  cli.write("case.yaml", "include: wrong_model.yaml\nexpect:\n");
  CHECK(cli.parallax({"check", "case.yaml"}).code == 0);
  CHECK(cli.parallax({"suite", "case.yaml"}).code == 2);  // no case
}

TEST_CASE("--fast leaves out the scenarios that do not say that they are") {
  const CliFixture cli;
  cli.write("scenario.yaml", "name: expects nothing\n");
  cli.write("edge.yaml", "name: expects nothing either\n");
  expect(cli, "slow.yaml", "{verdict: discrepancy}");
  expect(cli, "fast.yaml", "{verdict: discrepancy, fast: true}");
  const auto document = json_of(cli, {"suite", ".", "--fast"});
  REQUIRE(document["cases"].size() == 2);  // wrong_model.yaml is fast, too
  CHECK(document["cases"][0]["case"] == "fast.yaml");
  CHECK(cli.parallax({"suite", "slow.yaml", "--fast"}).code == 2);
}

TEST_CASE("an interrupted suite tells what was not run") {
  const CliFixture cli;
  cli.write("scenario.yaml", "name: expects nothing\n");
  cli.write("edge.yaml", "name: expects nothing either\n");
  expect(cli, "long.yaml", "{rate: {between: [0, 1], runs: 1000000}}");
  ProcessOptions options;
  int looks = 0;
  options.signal_when = [&] { return ++looks > 100 ? SIGTERM : 0; };
  const auto result = cli.parallax({"suite", ".", "--junit", "junit.xml"}, options);
  CHECK(result.code == 128 + SIGTERM);
  CHECK(holds(cli.read("junit.xml"), "not finished"));
}

TEST_CASE("a wrong expectation is refused where it stands") {
  const CliFixture cli;
  const auto complaint = [&](const std::string& what) {
    expect(cli, "case.yaml", what);
    const auto result = cli.parallax({"check", "case.yaml"});
    CHECK(result.code == 3);
    return result.err;
  };
  CHECK(holds(complaint("{rate: {runs: 10}}"), "lacks the key `between`"));
  CHECK(holds(complaint("{rate: {between: [0.3, 0.2]}}"), "the lower first"));
  CHECK(holds(complaint("{rate: {between: [0.3, 1.2]}}"), "from 0 to 1"));
  CHECK(holds(complaint("{rate: {between: 0.3}}"), "between"));
  CHECK(holds(complaint("{rat: {between: [0, 1]}}"), "`rate`"));
  CHECK(holds(complaint("{}"), "expects nothing"));
  CHECK(holds(complaint("{fast: true}"), "expects nothing"));
  CHECK(holds(complaint("{fluents: [BoxIn(r3)]}"), "`BoxIn(r1)`"));
  CHECK(holds(complaint("{time_limit_s: 0}"), "time_limit_s"));
  CHECK(holds(complaint("{fast: 3}"), "fast"));
}

}  // namespace
}  // namespace parallax::test
