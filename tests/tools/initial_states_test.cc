// Traces with several initial states: which of them a run begins in, by `initial` and
// `start_weights`, the same bytes for any number of jobs and after an interruption, and bad input.

#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

/// Gates that are shut or not at the start, and a way through that needs the first one open. The
/// model `wrong.e` forgets that; the world is `world`.
class Gates : public CliFixture {
 public:
  explicit Gates(int gates, const std::string& world = "wrong.e") {
    std::string names = "g0";
    for (int i = 1; i < gates; ++i) names += ", g" + std::to_string(i);
    const auto common = "sort gate\ngate " + names +
                        "\nfluent Shut(gate)\nfluent There()\nfluent Waved()\nevent Go()\n"
                        "event Wave()\n!HoldsAt(There(),0).\n!HoldsAt(Waved(),0).\n"
                        "[time] Initiates(Wave(),Waved(),time).\n";
    write("wrong.e", common + "[time] Initiates(Go(),There(),time).\n");
    write("truth.e", common + "[time] !HoldsAt(Shut(g0),time) -> Initiates(Go(),There(),time).\n");
    write("go.lisp", "(perform (an action (type going)))\n(perform (an action (type waving)))\n");
    write("go.bind",
          "action going -> Go() ok: There() @t+1 else plan-failure\n"
          "action waving -> Wave() ok: Waved() @t+1 else plan-failure\n");
    scenario("gates.yaml", "wrong.e", world, "");
  }
  void scenario(const std::string& name, const std::string& model, const std::string& world,
                const std::string& more) const {
    write(name, "model: " + model +
                    "\nplan: go.lisp\nbind: go.bind\nhorizon: 2\n"
                    "constraints: [\"Happens(Wave(),time-1) | Happens(Go(),time-1) & "
                    "!HoldsAt(There(),time)\"]\n"
                    "mapping: {Shut(g): {flag: \"Shut({g})\", drawn: true}}\n"
                    "criterion: {kind: clean-runs, epsilon: 0.2}\nsimulator: {model: " +
                    world + "}\n" + more);
  }
  /// `more`, as further lines of the scenario, is refused.
  void refuses(const std::string& more, const std::string& code) const {
    CAPTURE(more);
    scenario("refused.yaml", "wrong.e", "wrong.e", more);
    const auto ran = parallax({"run", "refused.yaml", "--out", "refused"});
    CAPTURE(ran.err);
    CHECK(ran.code == 3);
    CHECK(ran.err.find(code) != std::string::npos);
  }
};

TEST_CASE("the same journal for any number of jobs, and wherever a run was interrupted") {
  const Gates cli(5);
  REQUIRE(cli.parallax({"run", "gates.yaml", "--out", "one"}).code == 0);
  const auto journal = cli.read("one/journal.ndjson");
  REQUIRE(cli.parallax({"run", "gates.yaml", "--jobs", "2", "--out", "two"}).code == 0);
  CHECK(cli.read("two/journal.ndjson") == journal);
  std::istringstream in(journal);
  std::string line, before;
  for (int number = 1; std::getline(in, line); ++number) {
    before += line + '\n';
    if (number % 13 != 1) continue;
    CAPTURE(number);
    const auto folder = "cut" + std::to_string(number);
    std::filesystem::create_directory(cli.folder() / folder);
    cli.write(folder + "/journal.ndjson", before + "{\"trace\":1,\"sam");
    CHECK(cli.parallax({"run", "gates.yaml", "--out", folder, "--resume"}).code == 0);
    CHECK(cli.read(folder + "/journal.ndjson") == journal);
  }
}

TEST_CASE("each state is tried; the first alone only where the scenario says so") {
  const Gates cli(2, "truth.e");
  const auto found = json_of(cli, {"run", "gates.yaml", "--out", "all"}, 1);
  CHECK(found.at("simulations") <= 4);
  cli.scenario("first.yaml", "wrong.e", "truth.e", "initial: first\n");
  const auto first = cli.parallax({"run", "first.yaml", "--out", "first"});
  CHECK(first.code == 0);
  CHECK(first.out.find("in 1 of 4 initial states") != std::string::npos);
}

TEST_CASE("states of weight 0 are left out, and with them traces that have no others") {
  const Gates cli(2);
  const std::string shut = "start_weights: [{when: \"HoldsAt(Shut(g0),0)\", weight: 0}]\n";
  cli.scenario("weights.yaml", "wrong.e", "truth.e", shut);
  const auto left = json_of(cli, {"run", "weights.yaml", "--out", "left"});
  CHECK(left.at("traces").at(0).at("initial_states").at("all") == 2);
  cli.scenario("traces.yaml", "truth.e", "truth.e", shut);
  const auto ran = cli.parallax({"run", "traces.yaml", "--out", "traces"});
  CAPTURE(ran.err);
  CHECK(ran.code == 0);
  CHECK(ran.err.find("1 trace is left out") != std::string::npos);
}

TEST_CASE("more states than are listed are drawn, and that is inconclusive") {
  const Gates cli(14);
  const auto ran = cli.parallax({"run", "gates.yaml", "--out", "many"});
  CAPTURE(ran.out);
  CHECK(ran.code == 4);
  CHECK(ran.out.find("more than 10000 initial states") != std::string::npos);
}

TEST_CASE("bad input is refused at its place") {
  const Gates cli(2);
  const std::string weights = "start_weights: [{when: \"HoldsAt(Shut(g0),0)\", weight: 2}]\n";
  cli.refuses("initial: first\n" + weights, "E5109");
  cli.refuses("initial: all\n" + weights, "E5109");
  cli.refuses("initial: weights\n", "E5106");
  cli.refuses("initial: every\n", "E5111");
  cli.refuses("start_weights: [{when: \"HoldsAt(Open(g0),0)\", weight: 2}]\n", "E2101");
  cli.refuses(
      "start_weights: [{when: \"HoldsAt(Shut(g0),0) | !HoldsAt(Shut(g0),0)\", weight: 0}]\n",
      "E5109");
  cli.scenario("idle.yaml", "wrong.e", "wrong.e",
               "start_weights: [{when: \"HoldsAt(There(),0)\", weight: 2}]\n");
  const auto idle = cli.parallax({"run", "idle.yaml", "--out", "idle"});
  CHECK(idle.code == 0);
  CHECK(idle.err.find("no initial state has what is asked for") != std::string::npos);
}

TEST_CASE("a journal of another law, or of another number of states, is not continued") {
  const Gates cli(2);
  REQUIRE(cli.parallax({"run", "gates.yaml", "--out", "out"}).code == 0);
  const auto refuses = [&] {
    const auto ran = cli.parallax({"run", "gates.yaml", "--out", "out", "--resume"});
    CAPTURE(ran.err);
    CHECK(ran.code == 3);
    CHECK(ran.err.find("its initial states are drawn otherwise") != std::string::npos);
  };
  cli.replace("out/journal.ndjson", "uniform of 4", "uniform of 5");
  refuses();
  cli.replace("out/journal.ndjson", "\"initial_states\":\"uniform of 5\",", "");
  refuses();
}

}  // namespace
}  // namespace parallax::test
