// Initial states from which no trace meets the constraints are not simulated, and the run says so.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

ProcessResult run(const CliFixture& cli, const std::string& out) {
  return cli.parallax({"run", "scenario.yaml", "--epsilon", "0.5", "--out", out});
}

TEST_CASE("an initial state that leads to no trace is named") {
  const CliFixture cli;
  CHECK_FALSE(has(run(cli, "fixed").out, "bound"));
  // The box may lie in either region; the plan looks for it in r2 only.
  cli.replace("start.e", "HoldsAt(BoxIn(r2),0).", "!HoldsAt(Holding(),0).");
  const auto open = run(cli, "open");
  CAPTURE(open.err);
  CHECK(open.code == 0);
  CHECK_MESSAGE(has(open.out,
                    "bound     1 initial state leads to no trace up to the horizon and is not "
                    "simulated: BoxIn(r1)\n"),
                open.out);
  const auto report = nlohmann::json::parse(cli.read("open/report.json"));
  REQUIRE(report.at("bounds").size() == 1);
  CHECK(has(report.at("bounds").at(0), "BoxIn(r1)"));
}

TEST_CASE("where every initial state leads to a trace nothing is said") {
  const CliFixture cli;
  cli.replace("start.e", "HoldsAt(BoxIn(r2),0).", "!HoldsAt(Holding(),0).");
  cli.replace("scenario.yaml",
              "{region} (Happens(Place(region),time-1) & HoldsAt(BoxIn(region),time))",
              "Happens(Go(r2),time-1)");
  const auto all = run(cli, "all");
  CAPTURE(all.err);
  CHECK(all.code == 0);
  CHECK(has(all.out, "initial states"));
  CHECK_FALSE(has(all.out, "bound"));
}

TEST_CASE("a run that stops at a discrepancy says nothing of other initial states") {
  const CliFixture cli;
  cli.replace("start.e", "HoldsAt(BoxIn(r2),0).", "!HoldsAt(Holding(),0).");
  const auto found = cli.parallax({"run", "edge.yaml", "--out", "edge"});
  CHECK(found.code == 1);
  CHECK_FALSE(has(found.out, "leads to no trace"));
}

}  // namespace
}  // namespace parallax::test
