// Starts, fluents and states that a run leaves out stand in its answer, whoever reads it: summary,
// page, rates, proof.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/two_models.h"

namespace parallax::test {
namespace {

bool said(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The arm may be parked or not, and nothing else is open.
void leave_arm_open(const TwoModels& cli) {
  cli.write("two/start.e", "[drawer] !HoldsAt(Open(drawer),0).\n");
}

TEST_CASE("initial states of the weight 0 are named, also where all their traces go") {
  const TwoModels cli;
  leave_arm_open(cli);
  const auto scenario = cli.world(
      "load opens.e\n", "start_weights: [{when: \"!HoldsAt(Parked(),time)\", weight: 0}]\n");
  const auto ran = cli.parallax({"run", scenario, "--epsilon", "0.5", "--out", "weighed"});
  CAPTURE(ran.err);
  CHECK(ran.code == 0);
  CHECK_MESSAGE(
      said(ran.out, "1 initial state is not simulated, as `start_weights` gives it the weight 0"),
      ran.out);
  const auto rates = cli.parallax({"rates", scenario, "--runs", "10"});
  CHECK(said(rates.out, "bound: 1 initial state is not simulated"));
  CHECK(cli.parallax({"report", "weighed", "-o", "weighed.html"}).code == 0);
  CHECK(said(cli.read("weighed.html"), "1 initial state is not simulated"));
  // With equal weights there is nothing to say.
  const auto all = cli.world("load opens.e\n",
                             "start_weights: [{when: \"!HoldsAt(Parked(),time)\", weight: 1}]\n");
  CHECK_FALSE(
      said(cli.parallax({"run", all, "--epsilon", "0.5", "--out", "all"}).out, "the weight 0"));
}

TEST_CASE("fluents that are not compared stand in the summary and on the page") {
  const TwoModels cli;
  const auto scenario = cli.world("load opens.e\n", "mapping: {Open(drawer): ignored}\n");
  const auto ran = cli.parallax({"run", scenario, "--epsilon", "0.5", "--out", "ignored"});
  CAPTURE(ran.err);
  CHECK(ran.code == 0);
  CHECK_MESSAGE(said(ran.out, "without   Open(..): not compared"), ran.out);
  CHECK(cli.parallax({"report", "ignored", "-o", "ignored.html"}).code == 0);
  CHECK(said(cli.read("ignored.html"), "<dt>Not compared</dt><dd>Open(..)</dd>"));
  CHECK_FALSE(
      said(cli.parallax({"run", "two/agree.yaml", "--epsilon", "0.5", "--out", "whole"}).out,
           "not compared"));
}

TEST_CASE("rates name initial states that lead to no trace") {
  const CliFixture cli;
  cli.replace("start.e", "HoldsAt(BoxIn(r2),0).", "!HoldsAt(Holding(),0).");
  const auto rates = cli.parallax({"rates", "scenario.yaml", "--runs", "2"});
  CHECK_MESSAGE(said(rates.out, "bound: 1 initial state leads to no trace"), rates.out);
  const auto document =
      nlohmann::json::parse(cli.parallax({"rates", "scenario.yaml", "--runs", "2", "--json"}).out);
  CHECK(document.at("bounds").size() == 1);
}

TEST_CASE("the first initial state alone is not for executions of a plan") {
  const TwoModels cli;
  const auto scenario = cli.world("load opens.e\n", "initial: first\n");
  const auto ran = cli.parallax({"run", scenario, "--execution", "closed-loop", "--out", "loop"});
  CHECK(ran.code == 2);
  CHECK(said(ran.err, "`initial: first` is of traces"));
}

}  // namespace
}  // namespace parallax::test
