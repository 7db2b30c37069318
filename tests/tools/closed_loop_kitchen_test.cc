// Plans of the kitchen executed: a handler that the model has no use for runs where a drawer stands
// in the way of the first drive, and the repaired plan stays clean to its end.

#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/tools/cli_json.h"
#include "tests/tools/kitchen_copy.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

/// The plan's file up to `deliver`, followed by the given text.
std::string up_to_deliver(const CliFixture& cli, const std::string& plan, const std::string& rest) {
  const auto text = cli.read(plan);
  const auto at = text.find("(def-cram-function deliver");
  REQUIRE(at != std::string::npos);
  return text.substr(0, at) + rest;
}

TEST_CASE("the open drawer is met, the handler runs, and the model has no path like that") {
  const KitchenCopy cli;
  cli.write("kitchen/handled.lisp", up_to_deliver(cli, "kitchen/plan2.lisp", R"(
(def-cram-function drive-past (?pose)
  (cpl:with-retry-counters ((tries 1))
    (cpl:with-failure-handling
        ((common-fail:navigation-low-level-failure (e)
           (cpl:do-retry tries
             (dolist (?drawer '(:d-low :d-mid :d-top))
               (exe:perform (desig:an action (type closing) (arm right)
                                      (object (desig:an object (name ?drawer))))))
             (park-arms)
             (cpl:retry))))
      (drive-to ?pose))))
(def-cram-function fetch-spoon ()
  (pick-up (find-in-drawers :spoon))
  (park-arms)
  (drive-past *table-pose*))
(fetch-spoon)
)"));
  cli.write("kitchen/handled.yaml",
            "include: plan2.yaml\nplan: handled.lisp\nexecution: closed-loop\nexpect:\n");
  const auto report =
      json_of(cli, {"run", "kitchen/handled.yaml", "--out", "out", "--jobs", "2"}, 1);
  const auto& found = report.at("discrepancies").at(0);
  CHECK(found.at("cause").at("text") == "Go(bTable): navigation-pose-unreachable");
  CHECK(found.at("differs").at("outcome") == true);
  CHECK(found.at("repeated") == "bit-equal");
  const auto& path = found.at("path");
  const auto event = found.at("differs").at("event").get<std::size_t>();
  CHECK(path.at(event).at("condition") == "navigation-pose-unreachable");
  REQUIRE(path.size() > event + 1);
  CHECK(path.at(event + 1).at("event") == "CloseDrawer(right,dLow)");
  const auto& fluents = found.at("first");
  CHECK(std::any_of(fluents.begin(), fluents.end(), [](const Json& fluent) {
    return fluent.at("fluent") == "RobotAt(bTable)" && fluent.at("observed") == false;
  }));
  CHECK(report.at("traces").at(0).at("initial_states") == 18);
  CHECK(report.at("coverage").at("handlers").at("covered") > 0);
  CHECK(cli.parallax({"replay", "out"}).code == 0);
}

TEST_CASE("a plan of the kitchen is not too large for the report to say what was covered") {
  const KitchenCopy cli;
  const auto run = cli.parallax({"run", "kitchen/plan2.yaml", "--out", "out", "--max-runs", "1"});
  CHECK(run.code == 4);
  CHECK(run.out.starts_with("inconclusive: 3 of 3 traces had fewer runs than the criterion"));
  const auto coverage = Json::parse(cli.read("out/report.json")).at("coverage");
  CHECK(coverage.at("performs").at("covered") > 0);
  CHECK(coverage.at("axioms").at("covered") > 0);
}

TEST_CASE("the repaired plan, executed to its end, stays clean") {
  const KitchenCopy cli;
  cli.write("kitchen/whole.yaml",
            "include: plan2_modified.yaml\nexecution: closed-loop\nexpect:\n");
  const auto report = json_of(cli, {"run", "kitchen/whole.yaml", "--epsilon", "0.5"});
  CHECK(report.at("verdict") == "no-discrepancy");
  const auto& paths = report.at("traces").at(0).at("paths");
  CHECK(paths.size() > 1);
  for (const auto& path : paths) {
    CHECK(path.at("end") == "done");
    CHECK(path.at("events").back() == "ParkArm(right)");
    CHECK(path.at("events").at(path.at("events").size() - 3) == "PlaceAt(left,bowl1,pt2)");
  }
}

}  // namespace
}  // namespace parallax::test
