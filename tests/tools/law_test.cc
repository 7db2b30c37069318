// Laws of starts as users meet them: through the protocol, with physics, in closed loop, and
// refused.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

using Json = nlohmann::json;

/// A world of words behind the protocol: a box that is picked up at 1.75 slips.
constexpr const char* kWords = R"sh(robot=0.5 box=1.5 held=false
number() { rest=${line#*"\"$1\":"}; rest=${rest%%,*}; echo "${rest%%\}*}"; }
while read -r line; do
  id=$(number id)
  reply='{"status":"ok","sim_time":1}'
  case $line in
    *'"hello"'*) reply='{"protocol":1,"name":"words","version":"1","determinism":"bitwise","seeds":true,"time_step":0.01,"params":[{"name":"robot.x","settable":true},{"name":"box.x","settable":true},{"name":"box.y","settable":true},{"name":"box.yaw","settable":true},{"name":"box.held"}],"actions":[{"name":"going"},{"name":"picking-up"},{"name":"placing"}]}' ;;
    *'"reset"'*) robot=$(number robot.x) box=$(number box.x) held=false ;;
    *'"going"'*) robot=$(number target.x) ;;
    *'"picking-up"'*)
      if [ "$box" = 1.75 ]; then
        reply='{"status":"failed","sim_time":1,"reason":"slipped"}'
      else
        held=true
      fi ;;
    *'"placing"'*) if [ $held = true ]; then held=false box=0.5; fi ;;
    *'"observe"'*) reply="{\"state\":{\"robot.x\":$robot,\"box.x\":$box,\"box.held\":$held}}" ;;
  esac
  printf '{"id":%s,"result":%s}\n' "$id" "$reply"
done
)sh";

TEST_CASE("a known probability under a law is met through the protocol") {
  const CliFixture cli;
  cli.write("words.sh", kWords);
  // Three boxes of four lie at 1.25, of those that are at 1.9 none is let through.
  cli.write("law.yaml",
            "include: scenario.yaml\n"
            "simulator: {command: [sh, words.sh]}\n"
            "sampling:\n"
            "  variables: {box.x: {choice: {1.25: 3, 1.75: 1, 1.9: 2}}}\n"
            "  require: ['box.x < 1.8 and robot.x > 0']\n");
  const auto rates = json_of(
      cli, {"rates", "law.yaml", "--runs", "150", "--confidence", "0.999999", "--jobs", "2"});
  const auto& trace = rates["traces"][0];
  CHECK(trace["runs"] == 150);
  CHECK(trace["any"]["lower"] < 0.25);
  CHECK(trace["any"]["upper"] > 0.25);
  CHECK(trace["any"]["upper"] < 0.5);
  const auto& law = trace["law"];
  CHECK(law["drawn"] == 150);
  CHECK(law["refused_share"].get<double>() == doctest::Approx(1.0 / 3.0).epsilon(0.3));
  CHECK(law["conditions"][0]["condition"] == "box.x < 1.8 and robot.x > 0");
  CHECK(law["words"][0] == "box.x 1.25 (50 %) or 1.75 (16.67 %) or 1.9 (33.33 %)");
}

TEST_CASE("a simulator whose script has changed goes on with no run, and replay tells it") {
  const CliFixture cli;
  cli.write("words.sh", kWords);
  cli.write("other.yaml", "include: scenario.yaml\nsimulator: {command: [sh, words.sh]}\n");
  const auto run =
      cli.parallax({"run", "other.yaml", "--allow-commands", "--max-runs", "2", "--out", "one"});
  CAPTURE(run.err);
  REQUIRE(run.code == 4);
  const std::vector<std::string> replay = {"replay", "one", "--sample", "1.1", "--allow-commands"};
  const std::vector<std::string> resume = {
      "run", "other.yaml", "--allow-commands", "--max-runs", "3", "--resume", "--out", "one"};
  auto replayed = cli.parallax(replay);
  CHECK(replayed.code == 0);
  CHECK_FALSE(holds(replayed.err, "W7180"));
  cli.write("words.sh", std::string(kWords) + "# another version\n");
  replayed = cli.parallax(replay);
  CHECK(replayed.code == 0);
  CHECK(holds(replayed.err, "W7180"));
  const auto refused = cli.parallax(resume);
  CHECK(refused.code == 3);
  CHECK_MESSAGE(holds(refused.err, "its simulator's program or script is"), refused.err);
  cli.write("words.sh", kWords);
  CHECK(cli.parallax(resume).code == 4);
}

TEST_CASE("a suite takes over no result of a simulator that a command starts") {
  const CliFixture cli;
  cli.write("words.sh", kWords);
  const auto scenario = cli.read("scenario.yaml");
  cli.write("other.yaml", scenario.substr(0, scenario.find("expect:")) +
                              "simulator: {command: [sh, words.sh]}\nlimits: {max_runs: 2}\n"
                              "expect: {verdict: inconclusive}\n");
  const std::vector<std::string> suite = {"suite", "other.yaml", "--allow-commands", "--no-cache"};
  auto resumed = suite;
  resumed.emplace_back("--resume");
  REQUIRE(cli.parallax(suite).code == 0);
  // Nobody knows what the program reads, so it is run again even if its script has not changed.
  CHECK(json_of(cli, resumed)["reused"] == 0);
  cli.write("words.sh", std::string(kWords) + "# another version\n");
  CHECK(json_of(cli, resumed)["reused"] == 0);
  // Without an expected verdict it is no pass.
  cli.replace("other.yaml", "verdict: inconclusive", "max_simulations: 5");
  auto reported = suite;
  reported.insert(reported.end(), {"--junit", "r.xml", "--markdown", "r.md"});
  const auto open = cli.parallax(reported);
  CHECK(open.code == 4);
  CHECK(holds(open.out, "OPEN  other.yaml"));
  CHECK(open.out.ends_with("\n0 passed, 0 failed, 1 inconclusive\n"));
  CHECK(holds(cli.read("r.xml"), "failures=\"0\" errors=\"0\" skipped=\"1\""));
  CHECK(holds(cli.read("r.xml"), "<skipped message=\"inconclusive: the run is inconclusive"));
  CHECK(holds(cli.read("r.md"), "| inconclusive |"));
  CHECK(json_of(cli, suite, 4)["inconclusive"] == 1);
  CHECK(holds(cli.read("out/suite/results.json"), "\"outcome\": \"inconclusive\""));
  // Neither is it a failure where another verdict is expected.
  cli.replace("other.yaml", "max_simulations: 5", "verdict: discrepancy");
  const auto undecided = json_of(cli, suite, 4);
  CHECK(undecided["failed"] == 0);
  CHECK(undecided["cases"][0]["problems"][0] == "verdict inconclusive, expected discrepancy");
  cli.replace("other.yaml", "verdict: discrepancy", "verdict: discrepancy, max_simulations: 1");
  CHECK(json_of(cli, suite, 1)["failed"] == 1);
}

constexpr const char* kEdgeLaw =
    "include: edge.yaml\n"
    "sampling:\n"
    "  variables:\n"
    "    box.x: {triangular: [1.2, 1.4, 2]}\n"
    "    box.yaw: {normal: {mean: 0, sd: 0.02}, within: [-0.05, 0.05]}\n"
    "    box.y: {formula: 'offset * (box.x - 1)'}\n"
    "  parameters: {offset: [-0.002, 0.002]}\n"
    "  require:\n"
    "    - box.x - robot.x > 0.7\n";

TEST_CASE("runs by a law: the claim names it, they repeat bit for bit, and go on") {
  const CliFixture cli;
  cli.write("law.yaml", kEdgeLaw);
  const auto check = cli.parallax({"check", "law.yaml"});
  CAPTURE(check.err);
  CHECK(check.code == 0);
  const auto run = json_of(cli, {"run", "law.yaml", "--out", "one"}, 1);
  const auto& trace = run["traces"][0];
  const auto& law = trace["law"];
  CHECK(law["drawn"].get<int>() >= 1);
  CHECK(law["words"].dump().find("given box.x - robot.x > 0.7") != std::string::npos);
  const auto found = run["discrepancies"][0];
  const auto id = "1." + std::to_string(found["sample"].get<int>());
  const auto replay = cli.parallax({"replay", "one", "--sample", id});
  CAPTURE(replay.err);
  CHECK(replay.code == 0);
  CHECK(replay.out.find("identical") != std::string::npos);
  const auto two = cli.parallax({"run", "law.yaml", "--out", "two", "--jobs", "2", "--json"});
  const auto one = cli.parallax({"run", "law.yaml", "--out", "two-again", "--json"});
  CHECK(two.code == 1);
  auto jobs = Json::parse(two.out), alone = Json::parse(one.out);
  for (auto* document : {&jobs, &alone}) {
    document->erase("timing");
    document->erase("discrepancies");  // their commands name the folder
  }
  CHECK(jobs == alone);
  // The long and the short report state the refused draws; a claim stands where runs were clean.
  const auto account = cli.parallax({"run", "law.yaml", "--out", "three", "-v"});
  CHECK(account.out.find("start law") != std::string::npos);
  CHECK(account.out.find("refused") != std::string::npos);
  cli.write("clean.yaml", "include: law.yaml\nplan: fetch.lisp\nexpect:\n");
  const auto clean = json_of(cli, {"run", "clean.yaml", "--out", "clean", "--epsilon", "0.3"}, 0);
  CHECK(clean["traces"][0]["claim"].get<std::string>().find(
            "drawn from the start region by the scenario's law (") != std::string::npos);
  const auto page = cli.parallax({"report", "clean", "-o", "page.html"});
  CAPTURE(page.err);
  CHECK(page.code == 0);
  CHECK(cli.read("page.html").find("by the scenario") != std::string::npos);
}

TEST_CASE("executions of a plan begin by the law, too") {
  const CliFixture cli;
  cli.write("law.yaml", std::string(kEdgeLaw) + "plan: fetch.lisp\nexpect:\n");
  const auto run = json_of(
      cli, {"run", "law.yaml", "--out", "loop", "--execution", "closed-loop", "--epsilon", "0.3"});
  const auto& stream = run["traces"][0];
  CHECK(stream["claim"].get<std::string>().find("by the scenario's law (") != std::string::npos);
  CHECK(stream["law"]["refused"].get<int>() > 0);
  const auto replay = cli.parallax({"replay", "loop", "--sample", "1.1"});
  CAPTURE(replay.err);
  CHECK(replay.code == 0);
}

TEST_CASE("laws that leave too little are refused at the condition that does it") {
  const CliFixture cli;
  const auto refused = [&](const std::string& sampling, const std::string& place,
                           const std::string& words) {
    cli.write("law.yaml", "include: edge.yaml\nsampling:\n" + sampling);
    for (const auto* command : {"run", "check"}) {
      const auto result = cli.parallax({command, "law.yaml"});
      CAPTURE(result.err);
      CHECK(result.code == 3);
      CHECK(result.err.find("law.yaml:" + place) != std::string::npos);
      CHECK(result.err.find(words) != std::string::npos);
    }
  };
  refused("  require: ['robot.x < 0.5', 'box.x > 1.9997']\n", "3:31", "`box.x > 1.9997` alone");
  refused("  variables: {box.x: {choice: {0.5: 1, 2.5: 1}}}\n", "3:15", "E5152");
  refused("  variables: {box.x: {triangular: [0, 0.5, 0.9]}}\n", "2:1", "E5301");
  refused("  variables: {box.y: {normal: {mean: 0, sd: 1}, within: [50, 60]}}\n", "3:49", "E5152");
  refused("  require: ['wall.x < box.x']\n", "3:14", "the simulator has no variable `wall.x`");
  refused("  areas: {box: {disc: {at_m: [5, 5], radius_m: 0.1}}}\n", "3:11", "E5153");
}

}  // namespace
}  // namespace parallax::test
