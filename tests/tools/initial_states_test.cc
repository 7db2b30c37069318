// Traces with several initial states: which of them a run begins in, by `initial` and
// `start_weights`, the same bytes for any number of jobs and after an interruption, and bad input.

#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tests/tools/gates.h"

namespace parallax::test {
namespace {

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
