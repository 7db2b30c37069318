// `parallax run --search`: starts that a strategy proposes, before the draws that are claimed from.

#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::int64_t lines_with(const std::string& text, const std::string& part) {
  const auto lines = lines_of(text);
  return std::count_if(lines.begin(), lines.end(),
                       [&](const auto& line) { return holds(line, part); });
}

/// The box is put down so near the border that one start in a hundred or so goes wrong.
constexpr const char* kEdge = "edge.yaml";

TEST_CASE("search: what it finds is a discrepancy like others, recorded and replayed") {
  const CliFixture cli;
  const auto ran = cli.parallax({"run", kEdge, "--search", "30", "--out", "r", "--json"});
  CAPTURE(ran.err);
  REQUIRE(ran.code == 1);
  const auto report = Json::parse(ran.out);
  const auto& trace = report["traces"][0];
  CHECK(trace["search"]["found"] == true);
  CHECK(trace["search"]["strategy"] == "portfolio");
  CHECK(trace["guided"] == trace["search"]["simulations"]);
  CHECK(trace["simulations"] == 0);  // no draw was made
  const auto sample = trace["search"]["simulations"].get<std::int64_t>();
  CHECK(report["discrepancies"][0]["sample"] == sample);
  CHECK(holds(cli.read("r/report.txt"), "  searched     "));
  CHECK(holds(trace["claim"], "nothing is claimed"));
  CHECK(lines_with(cli.read("r/journal.ndjson"), R"("phase":"search")") == sample);
  CHECK(lines_with(cli.read("r/journal.ndjson"), R"("phase":"confirm")") == 1);
  const auto replayed = cli.parallax({"replay", "r"});
  CHECK(replayed.code == 0);
  CHECK(holds(replayed.out, "1." + std::to_string(sample)));
  CHECK(cli.parallax({"explain", "r", "--runs", "0"}).code == 1);
  CHECK(cli.parallax({"report", "r"}).code == 0);
}

TEST_CASE("search: nothing found, then the claim is about draws alone") {
  const CliFixture cli;
  const auto ran = cli.parallax({"run", "scenario.yaml", "--search", "9", "--epsilon", "0.15",
                                 "--out", "r", "--json", "--samples", "rows.csv"});
  CAPTURE(ran.err);
  REQUIRE(ran.code == 0);
  const auto report = Json::parse(ran.out);
  const auto& trace = report["traces"][0];
  CHECK(trace["search"]["found"] == false);
  CHECK(trace["search"]["simulations"] == 9);
  CHECK(trace["search"]["nearest"]["margin"] > 0.0);
  CHECK(trace["simulations"] == 29);
  CHECK(trace["clean"] == 29);
  CHECK(holds(trace["claim"], "29 clean runs of 29"));
  CHECK(report["simulations"] == 38);
  CHECK(lines_of(cli.read("rows.csv")).size() == 39);
}

TEST_CASE("search: the number of jobs shows nowhere, and a run goes on where it ended") {
  const CliFixture cli;
  const std::vector<std::string> run = {"run", "scenario.yaml", "--search",
                                        "10",  "--epsilon",     "0.5"};
  const auto with = [&](std::vector<std::string> more) {
    auto all = run;
    all.insert(all.end(), more.begin(), more.end());
    return cli.parallax(all);
  };
  REQUIRE(with({"--out", "one"}).code == 0);
  REQUIRE(with({"--out", "three", "--jobs", "3"}).code == 0);
  CHECK(cli.read("one/journal.ndjson") == cli.read("three/journal.ndjson"));
  CHECK(without_timing(cli.read("one/report.json")).size() > 100);
  const auto whole = cli.read("one/journal.ndjson");
  // Ended in the midst of the search, and of the draws.
  for (const std::size_t kept : {1U, 4U, 9U, 15U}) {
    std::string text;
    const auto lines = lines_of(whole);
    for (std::size_t i = 0; i < kept; ++i) text += lines[i] + '\n';
    cli.write("three/journal.ndjson", text);
    REQUIRE(with({"--out", "three", "--resume", "--jobs", "2"}).code == 0);
    CHECK(cli.read("three/journal.ndjson") == whole);
  }
  // Not with another search,
  const auto other = cli.parallax(
      {"run", "scenario.yaml", "--search", "11", "--epsilon", "0.5", "--out", "one", "--resume"});
  CHECK(other.code == 3);
  CHECK(holds(other.err, "options.search"));
  const auto none =
      cli.parallax({"run", "scenario.yaml", "--epsilon", "0.5", "--out", "one", "--resume"});
  CHECK(none.code == 3);
  // nor with a start that the search does not propose.
  auto lines = lines_of(whole);
  auto record = nlohmann::ordered_json::parse(lines[3]);
  REQUIRE(record["phase"] == "search");
  record["initial"]["box.x"] = 1.5;
  lines[3] = record.dump();
  std::string text;
  for (const auto& line : lines) text += line + '\n';
  cli.write("one/journal.ndjson", text);
  const auto again = with({"--out", "one", "--resume"});
  CHECK(again.code == 3);
  CHECK(holds(again.err, "its start is not the one that the search proposes"));
}

TEST_CASE("search: every strategy, and a scenario that asks for one") {
  const CliFixture cli;
  for (const std::string strategy : {"uniform", "sobol", "boundary", "cross-entropy",
                                     "expected-improvement", "descent", "portfolio"}) {
    CAPTURE(strategy);
    cli.write("s.yaml", "include: scenario.yaml\nsearch: {runs: 6, strategy: " + strategy + "}\n");
    const auto ran =
        cli.parallax({"run", "s.yaml", "--epsilon", "0.5", "--out", "r-" + strategy, "--json"});
    CAPTURE(ran.err);
    REQUIRE(ran.code == 0);
    CHECK(Json::parse(ran.out)["traces"][0]["search"]["strategy"] == strategy);
  }
  cli.write("s.yaml", "include: scenario.yaml\nsearch: 5\n");
  const auto ran = cli.parallax({"run", "s.yaml", "--epsilon", "0.5", "--json"});
  CHECK(Json::parse(ran.out)["traces"][0]["search"]["asked"] == 5);
}

/// A simulator that ends as soon as it is to do anything.
constexpr const char* kEnding = R"sh(number() { rest=${line#*"\"$1\":"}; echo "${rest%%[,\}]*}"; }
while read -r line; do
  id=$(number id)
  case $line in
    *'"hello"'*) echo '{"id":'$id',"result":{"protocol":1,"name":"ending","version":"1","determinism":"none","seeds":false,"time_step":0.01,"params":[{"name":"robot.x","settable":true},{"name":"box.x","settable":true},{"name":"box.y","settable":true},{"name":"box.yaw","settable":true},{"name":"box.held"}],"actions":[{"name":"going"},{"name":"picking-up"},{"name":"placing"}]}}' ;;
    *) exit 3 ;;
  esac
done
)sh";

TEST_CASE("search: a simulator that is lost again and again ends it, and is told of once") {
  const CliFixture cli;
  cli.write("ending.sh", kEnding);
  cli.write("s.yaml", "include: scenario.yaml\nsimulator: {command: [sh, ending.sh]}\n");
  for (const std::string jobs : {"1", "3"}) {
    CAPTURE(jobs);
    const auto ran = cli.parallax({"run", "s.yaml", "--search", "12", "--jobs", jobs, "--json"});
    CAPTURE(ran.err);
    CHECK(ran.code == 4);
    CHECK(holds(ran.err, "E7107"));
    CHECK(holds(ran.err, "lost 3 times in a row"));
    CHECK(!holds(ran.err, "lost 4 times"));
    const auto trace = Json::parse(ran.out)["traces"][0];
    CHECK(trace["search"]["lost"] == 3);
    CHECK(trace["simulations"] == 0);
    CHECK(!holds(trace["caveats"].dump(), "no direction"));  // nothing was observed that could have
  }
  const auto rates =
      cli.parallax({"rates", "s.yaml", "--method", "importance", "--runs", "1000", "--json"});
  CAPTURE(rates.err);
  CHECK(rates.code == 4);
  CHECK(!holds(rates.err, "lost 4 times"));
  const auto trace = Json::parse(rates.out)["traces"][0];
  CHECK(trace["runs"] == 3);
  CHECK(trace["lost"] == 3);
  CHECK(trace["end"] == "stopped");
}

TEST_CASE("search: bad input") {
  const CliFixture cli;
  for (const std::string text : {"search: -1", "search: 10001", "search: {strategy: sobol}",
                                 "search: {runs: 3, strategy: s}", "search: {runs: 3, seed: 1}",
                                 "search: [3]", "search: many"}) {
    CAPTURE(text);
    cli.write("s.yaml", "include: scenario.yaml\n" + text + "\n");
    const auto ran = cli.parallax({"run", "s.yaml"});
    CHECK(ran.code == 3);
    CHECK(holds(ran.err, "s.yaml:2:"));
  }
  CHECK(cli.parallax({"run", "scenario.yaml", "--search", "x"}).code == 2);
  CHECK(cli.parallax({"run", "scenario.yaml", "--search-strategy", "sobol"}).code == 2);
  CHECK(
      cli.parallax({"run", "scenario.yaml", "--search", "4", "--execution", "closed-loop"}).code ==
      2);
}

}  // namespace
}  // namespace parallax::test
