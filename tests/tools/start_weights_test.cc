// Closed loop with initial states drawn by weight: frequencies compared with the weights, claims
// and the law that they are about, and faults in weights.

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

/// Two lamps, which are on or off at the start, and a switch for those that are on; `Hidden` is not
/// compared.
class Lamps : public CliFixture {
 public:
  Lamps() {
    write("lamps.e",
          "sort lamp\nlamp a, b\nfluent On(lamp)\nfluent Hidden()\nfluent Parked()\n"
          "predicate Fragile(lamp)\nevent Park()\n[time] Initiates(Park(),Parked(),time).\n"
          "!HoldsAt(Parked(),0).\nFragile(a).\n!Fragile(b).\n");
    write("lamps.lisp", "(perform (an action (type parking-arms)))\n");
    write("lamps.bind", "action parking-arms -> Park() ok: Parked() @t+1 else plan-failure\n");
    scenario("");
  }
  void scenario(const std::string& more) const {
    write("lamps.yaml",
          "model: lamps.e\nplan: lamps.lisp\nbind: lamps.bind\nhorizon: 2\n"
          "execution: closed-loop\nsimulator: {model: lamps.e}\n"
          "mapping: {On(l): {flag: \"On({l})\", drawn: true}, Hidden(): ignored}\n" +
              more);
  }
  std::string weights(const std::string& entries) const {
    scenario("start_weights: " + entries + "\n");
    return "lamps.yaml";
  }
};

/// Number of executions that began with these lamps on: "a", "ab", "".
std::map<std::string, int> starts_of(const CliFixture& cli, const std::string& folder) {
  std::map<std::string, int> out;
  std::istringstream in(cli.read(folder + "/journal.ndjson"));
  std::string line;
  while (std::getline(in, line)) {
    const auto object = Json::parse(line);
    if (!object.contains("sample")) continue;
    const auto& initial = object.at("initial");
    std::string on;
    if (initial.at("On(a)") == 1) on += "a";
    if (initial.at("On(b)") == 1) on += "b";
    ++out[on];
  }
  return out;
}

TEST_CASE("start weights: each state comes as often as its weight says") {
  const Lamps cli;
  // Both on: 6. Else a: 3. Else, with b or none, 1 where no entry holds. Sum 11.
  const auto scenario = cli.weights(
      "[{when: \"HoldsAt(On(a),time) & HoldsAt(On(b),time)\", weight: 6},\n"
      "                {when: \"HoldsAt(On(a),0)\", weight: 3}]");
  const auto report =
      json_of(cli, {"run", scenario, "--epsilon", "0.0023", "--max-runs", "3000", "--out", "out"});
  const double runs = report.at("simulations");
  REQUIRE(runs >= 2000);
  const auto starts = starts_of(cli, "out");
  for (const auto& [on, weight] :
       std::map<std::string, double>{{"ab", 6.0}, {"a", 3.0}, {"b", 1.0}, {"", 1.0}}) {
    const double p = weight / 11.0;
    CAPTURE(on);
    CHECK(std::abs(starts.at(on) - runs * p) < 5.0 * std::sqrt(runs * p * (1.0 - p)));
  }
  const auto& stream = report.at("traces").at(0);
  CHECK(stream.at("start_law") == "weights");
  CHECK(stream.at("claim").get<std::string>().find(
            "4 initial states, each as likely as its weight in `start_weights` and each "
            "tried, then ") != std::string::npos);
  CHECK(cli.read("out/report.txt").find("4, each as likely as its weight") != std::string::npos);
  // Without weights each is equally likely.
  cli.scenario("");
  const auto plain = json_of(cli, {"run", scenario, "--out", "plain"});
  CHECK(plain.at("traces").at(0).at("start_law") == "uniform");
  CHECK(plain.at("traces").at(0).at("claim").get<std::string>().find("each equally likely") !=
        std::string::npos);
}

TEST_CASE("start weights: no weight, no start; what is read of a run knows the law") {
  const Lamps cli;
  // A predicate of the model, and one state that is left.
  const auto scenario = cli.weights(
      "[{when: \"{lamp} (Fragile(lamp) & HoldsAt(On(lamp),time))\", weight: 0},\n"
      "                {when: \"!HoldsAt(On(b),time)\", weight: 0}]");
  const std::vector<std::string> run = {"run", scenario, "--out", "out"};
  const auto report = json_of(cli, run);
  CHECK(starts_of(cli, "out") == std::map<std::string, int>{{"b", 90}});
  CHECK(report.at("traces").at(0).at("initial_states") == 1);
  CHECK(report.at("traces").at(0).at("claim").get<std::string>().find(
            "the only initial state with a weight in `start_weights`") != std::string::npos);
  CHECK(cli.parallax({"replay", "out", "--sample", "1.7"}).code == 0);
  CHECK(cli.parallax({"coverage", "out"}).code == 0);
  CHECK(cli.parallax({"monitor", scenario, "out"}).code == 0);
  const auto guided = json_of(cli, {"run", scenario, "--starts", "guided", "--out", "guided"});
  CHECK(starts_of(cli, "guided").size() == 1);
  // Resumed, and the same bytes.
  const auto journal = cli.read("out/journal.ndjson");
  auto cut = journal.find('\n');
  for (int i = 0; i < 40; ++i) cut = journal.find('\n', cut + 1);
  cli.write("out/journal.ndjson", journal.substr(0, cut + 1));
  auto resume = run;
  resume.emplace_back("--resume");
  json_of(cli, resume);
  CHECK(cli.read("out/journal.ndjson") == journal);
  // Other weights are another run.
  cli.weights("[{when: \"HoldsAt(On(b),time)\", weight: 2}]");
  CHECK(cli.parallax(resume).code == 3);
  std::filesystem::remove(cli.folder() / "out/inputs.json");  // else the kept texts are repeated
  CHECK(cli.parallax({"replay", "out"}).code == 3);
}

TEST_CASE("start weights: what is wrong with them is said at its place") {
  const Lamps cli;
  struct Bad {
    std::string entries, code, text;
  };
  const std::vector<Bad> all = {
      {"[{when: \"HoldsAt(On(a),time)\", weight: -1}]", "E5109", "lamps.yaml:8:"},
      {"[{when: \"HoldsAt(On(a),time)\", weight: .inf}]", "E5", "lamps.yaml:8:"},
      {"[{when: \"HoldsAt(On(a),time)\"}]", "E5", "`weight`"},
      {"[{when: \"HoldsAt(On(a),time)\", wieght: 1}]", "E5", "`weight`"},
      {"[{when: \"HoldsAt(Onn(a),time)\", weight: 1}]", "E2", "lamps.yaml:8:"},
      {"[{when: \"HoldsAt(On(a),time\", weight: 1}]", "E1", "lamps.yaml:8:"},
      {"[{when: \"HoldsAt(On(a),1)\", weight: 1}]", "E7124", "lamps.yaml:8:"},
      {"[{when: \"HoldsAt(Hidden(),time)\", weight: 1}]", "E7124", "`Hidden()` is not compared"},
      {"[{when: \"HoldsAt(On(a),time)\", weight: 0}, {when: \"!HoldsAt(On(a),time)\", weight: 0}]",
       "E5109", "0 for each of the 4 that the model has"},
  };
  for (const auto& bad : all) {
    const auto result = cli.parallax({"run", cli.weights(bad.entries)});
    CAPTURE(bad.entries);
    CAPTURE(result.err);
    CHECK(result.code == 3);
    CHECK(result.err.find("error[" + bad.code) != std::string::npos);
    CHECK(result.err.find(bad.text) != std::string::npos);
  }
  // `check` reports the faults in formulas.
  const auto checked =
      cli.parallax({"check", cli.weights("[{when: \"HoldsAt(Onn(a),time)\", weight: 1}]")});
  CHECK(checked.code == 3);
}

}  // namespace
}  // namespace parallax::test
